#include "view/moods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/light_names.hpp"
#include "writing/edited_scene.hpp"

namespace photile::view {
namespace {

using nlohmann::json;

constexpr int version = 1;

glm::vec3 color_of(const std::string& hex) {
  const auto code =
      hex.size() == 7 && hex[0] == '#' ? parse_number<unsigned>(hex.substr(1), 16) : std::nullopt;
  if (!code) {
    throw std::invalid_argument(fmt::format("'{}' is not a colour such as #ffd9a0", hex));
  }
  return glm::vec3((*code >> 16) & 255, (*code >> 8) & 255, *code & 255) / 255.0f;
}

double kelvin_of(double value) {
  if (value >= limits::min_color_temperature && value <= limits::max_color_temperature) {
    return value;
  }
  throw std::invalid_argument(fmt::format("{} is not a colour temperature from {} to {}", value,
                                          limits::min_color_temperature,
                                          limits::max_color_temperature));
}

/// With four significant digits: further digits of a slider have no meaning.
double rounded(double power) { return *parse_number<double>(fmt::format("{:.4g}", power)); }

PowerUnit unit_of(const std::string& word) {
  if (word == "lm") return PowerUnit::lumen;
  if (word == "W") return PowerUnit::watt;
  throw std::invalid_argument(fmt::format("'{}' is not a unit; use lm or W", word));
}

}  // namespace

std::filesystem::path Moods::file_of(const std::filesystem::path& scene) {
  return std::filesystem::path(scene).replace_extension(".moods.json");
}

Moods::Moods(std::filesystem::path file) : file_(std::move(file)) {
  if (!std::filesystem::exists(file_)) return;
  std::string place = "the file";
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: {}: {}; fix or remove it", file_.string(), place, reason));
  };
  const std::string text = read_own_text(file_);
  check_json_depth(text, file_.string());
  const json document = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (document.is_discarded()) refuse("is not JSON");
  try {
    if (document.at("photile_moods") != version) {
      throw std::invalid_argument(fmt::format("\"photile_moods\" is not {}", version));
    }
    for (const auto& [name, lights] : document.at("moods").items()) {
      for (const auto& [light, setting] : lights.items()) {
        place = fmt::format("mood '{}', light '{}'", name, light);
        Setting read{std::nullopt, unit_of(setting.value("unit", "lm")), setting.value("on", true),
                     std::nullopt, 0};
        if (setting.contains("power")) read.power = setting["power"].get<double>();
        if (read.power && !(*read.power >= 0 && *read.power <= limits::max_light_power)) {
          throw std::invalid_argument(
              fmt::format("its power is not a number from 0 to {:g}", limits::max_light_power));
        }
        if (setting.contains("color")) read.color = color_of(setting["color"].get<std::string>());
        if (setting.contains("kelvin")) read.kelvin = kelvin_of(setting["kelvin"].get<double>());
        moods_[name][light] = read;
      }
    }
  } catch (const json::exception&) {  // its text is meaningful to programmers only
    refuse("contains a value of the wrong type");
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
}

std::vector<std::string> Moods::names() const {
  std::vector<std::string> names;
  for (const auto& [name, mood] : moods_) names.push_back(name);
  return names;
}

void Moods::keep(const std::string& name, const LightBoard& board) {
  auto moods = moods_;
  Mood& mood = moods[name];
  for (const LightControl& control : board.controls()) {
    mood[control.name] = {rounded(control.power), control.unit, control.on, control.color,
                          std::round(control.kelvin)};
  }
  write(moods);
  moods_ = std::move(moods);
}

void Moods::remove(const std::string& name) {
  auto moods = moods_;
  moods.erase(name);
  write(moods);
  moods_ = std::move(moods);
}

const Moods::Mood& Moods::named(const std::string& name) const {
  const auto found = moods_.find(name);
  if (found != moods_.end()) return found->second;
  std::string known;
  for (const auto& [other, mood] : moods_) known += (known.empty() ? "'" : ", '") + other + "'";
  throw UsageError(fmt::format("{}: there is no mood '{}'; there {}", file_.string(), name,
                               known.empty() ? "are none" : "is " + known));
}

std::vector<LightChange> Moods::changes(const std::string& name, const LightMix& mix) const {
  const Mood& mood = named(name);
  std::vector<std::string> there;
  for (const MixedLight& light : mix.lights) there.push_back(light.name);
  refuse_unknown_lights(name, there);
  std::vector<LightChange> changes;
  for (const MixedLight& light : mix.lights) {
    const auto found = mood.find(light.name);
    if (found == mood.end()) continue;
    const Setting& setting = found->second;
    if (!setting.on || setting.power == 0.0) {
      changes.push_back({light.name, "off"});
      continue;
    }
    const char* unit = symbol_of(setting.unit);
    if (setting.power) changes.push_back({light.name, fmt::format("{}{}", *setting.power, unit)});
    if (setting.kelvin > 0) {
      changes.push_back({light.name, fmt::format("{}K", setting.kelvin)});
    } else if (setting.color) {
      changes.push_back({light.name, hex_of(*setting.color)});
    }
  }
  return changes;
}

void Moods::apply(const std::string& name, LightBoard& board) const {
  const Mood& mood = named(name);
  std::vector<std::string> there;
  for (LightControl& control : board.controls()) {
    there.push_back(control.name);
    const auto setting = mood.find(control.name);
    if (setting == mood.end()) continue;
    if (const auto power = setting->second.power) {
      control.power = in_unit(*power, setting->second.unit, control.unit, board.lumen_per_watt());
    }
    control.on = setting->second.on;
    control.color = setting->second.color;
    control.kelvin = setting->second.kelvin;
  }
  refuse_unknown_lights(name, there);
}

void Moods::refuse_unknown_lights(const std::string& name,
                                  const std::vector<std::string>& there) const {
  for (const auto& [light, setting] : named(name)) {
    if (std::find(there.begin(), there.end(), light) != there.end()) continue;
    throw UsageError(fmt::format(
        "{}: mood '{}': there is no light '{}'; there {}; correct the mood or save it again",
        file_.string(), name, light, scene::names_like(light, there)));
  }
}

void Moods::write(const std::map<std::string, Mood>& moods) const {
  json document{{"photile_moods", version}, {"moods", json::object()}};
  for (const auto& [name, mood] : moods) {
    json& lights = document["moods"][name] = json::object();
    for (const auto& [light, setting] : mood) {
      json& entry = lights[light];
      entry = {{"on", setting.on}};
      if (setting.power) {
        entry["power"] = *setting.power;
        entry["unit"] = symbol_of(setting.unit);
      }
      if (setting.color) entry["color"] = hex_of(*setting.color);
      if (setting.kelvin > 0) entry["kelvin"] = setting.kelvin;
    }
  }
  write_file(file_, json_text(document, 2));
}

std::string write_mood(const Scene& scene, const SceneLoadOptions& load, LightBoard board,
                       const Moods& moods, const std::string& mood) {
  try {
    moods.apply(mood, board);
    const writing::EditedScene copy =
        writing::write_edited_scene(scene.source, load, board.mix(), mood);
    std::string told = fmt::format("{} is written", copy.file.filename().string());
    for (const std::string& line : copy.left_out) told += "\n" + line;
    return told;
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace photile::view
