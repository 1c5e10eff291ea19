#include "serve/page_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "common/ascii_text.hpp"
#include "image/display.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "render/setting.hpp"

namespace photile::serve {
namespace {

using nlohmann::json;

/// Pixels on a side of a picture, and bytes of all of its layers.
constexpr int most_side = 8192;
constexpr double most_picture_bytes = 1e9;
/// Settings that pages change.
constexpr std::array page_settings{"photons_emitted", "neighbours", "radius", "maps", "area"};

/// The sRGB colour that tints a light so.
glm::vec3 srgb_of(const glm::dvec3& tint) {
  const double most = std::max({tint.x, tint.y, tint.z, 1e-9});
  glm::vec3 colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] = static_cast<float>(image::srgb_from_linear(std::max(0.0, tint[c] / most)));
  }
  return colour;
}

}  // namespace

json parsed(const std::string& body) {
  check_json_depth(body, "request");
  json document = json::parse(body, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object()) throw InputError("request: is not a JSON object");
  return document;
}

glm::dvec3 direction_in(const JsonObject& object, const char* key) {
  const glm::dvec3 direction = object.vector(key);
  const double length = glm::length(direction);
  if (!(std::abs(length - 1) < 0.01)) object.refuse(fmt::format("'{}' is not of length 1", key));
  return direction / length;
}

view::FrameRequest view_in(const json& body, const LightMix& mix) {
  const JsonObject view(body, "view",
                        {"eye", "forward", "angle", "width", "height", "moving", "sky", "glare"});
  const glm::dvec3 eye = view.vector("eye"), forward = view.vector("forward");
  if (!(glm::length(forward) > 0.5)) view.refuse("'forward' is too short");
  view::FrameRequest request;
  request.camera = Camera::look_at(eye, eye + forward, {0, 1, 0}, view.number("angle", 0.01, 3.0));
  request.width = view.count("width", 1, most_side);
  request.height = view.count("height", 1, most_side);
  request.moving = body.value("moving", json()) == true;
  request.reflections = body.value("glare", json()) == true;
  request.powers = view::scales_of(mix);
  std::size_t layers = mix.lights.size();
  if (view.has("sky")) {
    const std::vector<std::uint32_t> patches = loading::patch_of_layers(mix);
    const json& sky = body["sky"];
    if (!sky.is_array() || sky.size() != patches.size()) view.refuse("'sky' has a wrong length");
    auto mixdown = std::make_shared<LayerMixdown>();
    mixdown->layer_of.assign(patches.size(), 0);
    mixdown->scale.assign(patches.size(), 1.0f);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (patches[i] != none) {
        const double power = sky[i].is_number() ? sky[i].get<double>() : -1;
        if (!(power >= 0 && power <= limits::max_light_power)) view.refuse("'sky' has a bad power");
        mixdown->scale[i] = static_cast<float>(power);
        continue;
      }
      mixdown->layer_of[i] = static_cast<std::uint32_t>(mixdown->layers.size());
      mixdown->layers.push_back(mix.lights[i].name);
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (patches[i] != none) {
        mixdown->layer_of[i] = static_cast<std::uint32_t>(mixdown->layers.size());
      }
    }
    mixdown->layers.emplace_back("sky");
    layers = mixdown->layers.size();
    request.mixdown = std::move(mixdown);
  }
  const double bytes = 16.0 * request.width * request.height * static_cast<double>(layers);
  if (bytes > most_picture_bytes) request.moving = true;  // no exact picture
  return request;
}

std::vector<ShownLight> lights_in(const json& body, std::size_t count) {
  std::vector<ShownLight> lights;
  const json rows = body.value("mix", json());
  const auto refuse = [] { throw InputError("mix: is not four numbers for each light"); };
  if (!rows.is_array() || rows.size() != count) refuse();
  for (const json& row : rows) {
    if (!row.is_array() || row.size() != 4) refuse();
    for (const json& number : row) {
      if (!number.is_number()) refuse();
      const double value = number.get<double>();
      if (!(value >= 0 && value <= limits::max_light_power)) refuse();
    }
    lights.push_back(
        {row[0].get<double>(), {row[1].get<float>(), row[2].get<float>(), row[3].get<float>()}});
  }
  return lights;
}

view::LightBoard board_in(const json& lights, const LightMix& mix) {
  view::LightBoard board(mix);
  for (view::LightControl& control : board.controls()) {
    if (!lights.is_object() || !lights.contains(control.name)) continue;
    const JsonObject light(lights[control.name], "mood", {"power", "on", "kelvin", "colour"});
    control.power = light.number("power", 0, limits::max_light_power);
    control.on = lights[control.name].value("on", json()) == true;
    if (light.has("kelvin")) {
      control.kelvin =
          light.number("kelvin", limits::min_color_temperature, limits::max_color_temperature);
    } else if (light.has("colour")) {
      control.color = srgb_of(light.vector("colour"));
    }
  }
  return board;
}

RenderParameters settings_in(const json& body, RenderParameters parameters) {
  for (const auto& [name, value] : body.items()) {
    if (std::find(page_settings.begin(), page_settings.end(), name) == page_settings.end()) {
      throw InputError(fmt::format("settings: a page cannot change '{}'", one_line(name)));
    }
    const Setting& setting = setting_named(name);
    SettingValue asked = std::string_view();
    const std::string word = value.is_string() ? value.get<std::string>() : "";
    if (value.is_number_unsigned() && std::holds_alternative<WholeNumbers>(setting.range)) {
      asked = value.get<std::uint64_t>();
    } else if (value.is_number()) {
      asked = value.get<double>();
    } else {
      asked = word;
    }
    check_value(name, asked, setting.range);
    setting.set(parameters, asked);
  }
  check(parameters);
  if (parameters.maps == MapMode::naive) throw UsageError("maps: naive has no light maps");
  return parameters;
}

json settings_of(const RenderParameters& parameters) {
  json list = json::array();
  for (const char* const name : page_settings) {
    const Setting& setting = setting_named(name);
    json& entry = list.emplace_back(json{{"name", name}, {"help", setting.help}});
    entry["value"] = setting.is_given(parameters) ? text_of(setting.value(parameters)) : "";
    if (const auto* words = std::get_if<Words>(&setting.range)) entry["words"] = words->words;
  }
  return list;
}

}  // namespace photile::serve
