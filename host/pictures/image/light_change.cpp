#include "image/light_change.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <string_view>

#include "common/ascii_text.hpp"
#include "image/display.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"

namespace photile {
namespace image {
namespace {

[[noreturn]] void refuse(const LightChange& change, const char* reason) {
  throw UsageError(fmt::format("light '{}': '{}' {}", change.name, change.value, reason));
}

/// A finite number >= 0.
std::optional<double> parse_amount(std::string_view text) {
  const auto value = parse_number<double>(text);
  return value && *value >= 0 ? value : std::nullopt;
}

SetColor parse_color(const LightChange& change) {
  const std::string_view digits = std::string_view(change.value).substr(1);
  const auto code = parse_number<std::uint32_t>(digits, 16);
  if (digits.size() != 6 || !code) {
    refuse(change, "is not a colour; use six hexadecimal digits such as #FFD8A0");
  }
  if (*code == 0) refuse(change, "is black; to turn the light off use 'off'");
  const auto channel = [&](unsigned shift) {
    return linear_from_srgb(((*code >> shift) & 0xFFu) / 255.0);
  };
  return {{channel(16), channel(8), channel(0)}};
}

/// 2700K
SetTemperature parse_temperature(const LightChange& change) {
  const auto kelvin =
      parse_amount(std::string_view(change.value).substr(0, change.value.size() - 1));
  if (!kelvin || *kelvin < limits::min_color_temperature ||
      *kelvin > limits::max_color_temperature) {
    refuse(change, "is not a colour temperature from 1000K to 40000K");
  }
  return {*kelvin};
}

bool remove_suffix(std::string_view& text, std::string_view suffix) {
  if (!text.ends_with(suffix)) return false;
  text.remove_suffix(suffix.size());
  return true;
}

SetPower parse_power(const LightChange& change) {
  std::string_view number = change.value;
  std::optional<PowerUnit> unit;
  if (remove_suffix(number, "lm")) {
    unit = PowerUnit::lumen;
  } else if (remove_suffix(number, "W")) {
    unit = PowerUnit::watt;
  }
  const std::optional<double> power = parse_amount(number);
  if (!power) {
    refuse(
        change,
        "is not a change of a light; use POWER, POWERlm or POWERW (0 or more), xFACTOR, PERCENT%, "
        "#RRGGBB, KELVINK or off");
  }
  return {*power, unit};
}

}  // namespace

Request understand(const LightChange& change) {
  if (change.value == "off") return ScalePower{0.0};
  if (change.value.starts_with('#')) return parse_color(change);
  if (change.value.ends_with('K')) return parse_temperature(change);
  if (change.value.starts_with('x')) {
    const std::optional<double> factor = parse_amount(std::string_view(change.value).substr(1));
    if (!factor) refuse(change, "is not a factor; use x and a number of 0 or more such as x1.5");
    return ScalePower{*factor};
  }
  if (change.value.ends_with('%')) {
    const std::string_view number =
        std::string_view(change.value).substr(0, change.value.size() - 1);
    const std::optional<double> percent = parse_amount(number);
    if (!percent) refuse(change, "is not a percentage; use a number of 0 or more such as 50%");
    return ScalePower{*percent / 100};
  }
  return parse_power(change);
}

void apply(MixedLight& light, const Request& request, double lumen_per_watt) {
  if (const auto* color = std::get_if<SetColor>(&request)) {
    const double emitted = luminance(color->linear * glm::dvec3(light.color));
    if (!(emitted > 0.0)) {
      throw UsageError(fmt::format(
          "light '{}' emits no light of that colour; choose one that overlaps its own colour",
          light.name));
    }
    light.tint = glm::vec3(color->linear / emitted);
    return;
  }
  if (const auto* temperature = std::get_if<SetTemperature>(&request)) {
    const glm::dvec3 own(light.color);
    const glm::dvec3 requested = scene::color_of_temperature(temperature->kelvin);
    for (int c = 0; c < 3; ++c) {
      if (own[c] > 0.0 || requested[c] == 0.0) continue;
      throw UsageError(fmt::format(
          "light '{}' is black in a channel that {} K needs; set the temperature when rendering",
          light.name, temperature->kelvin));
    }
    light.tint = glm::vec3(requested / glm::max(own, glm::dvec3(1e-30)));
    return;
  }
  double power = light.power;
  if (const auto* factor = std::get_if<ScalePower>(&request)) {
    power *= factor->factor;
  } else {
    const SetPower& set = std::get<SetPower>(request);
    power = in_unit(set.power, set.unit.value_or(light.unit), light.unit, lumen_per_watt);
  }
  if (!(power <= limits::max_light_power)) {
    throw UsageError(
        fmt::format("light '{}': its power would be {:g}; the limit is {:g}; reduce it", light.name,
                    power, limits::max_light_power));
  }
  light.power = power;
}

std::size_t index_of(const LightMix& mix, const std::string& name) {
  for (std::size_t i = 0; i < mix.lights.size(); ++i) {
    if (mix.lights[i].name == name) return i;
  }
  std::vector<std::string> names;
  for (const MixedLight& light : mix.lights) names.push_back(light.name);
  throw UsageError(
      fmt::format("there is no light '{}'; there {}", name, scene::names_like(name, names)));
}

std::vector<std::size_t> indices_of(const LightMix& mix, const std::string& glob) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < mix.lights.size(); ++i) {
    if (mix.lights[i].name == glob) return {i};
    if (::fnmatch(glob.c_str(), mix.lights[i].name.c_str(), 0) == 0) all.push_back(i);
  }
  if (all.empty()) all.push_back(index_of(mix, glob));
  return all;
}

}  // namespace image

LightChange LightChange::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(
        fmt::format("'{}' is not a change of a light; use NAME=POWER, NAME=xFACTOR, NAME=#RRGGBB, "
                    "NAME=KELVINK or NAME=off",
                    text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void change_lights(LightMix& mix, const std::vector<LightChange>& changes) {
  LightMix changed = mix;  // a refused change leaves the mix as it was
  for (const LightChange& change : changes) {
    for (const std::size_t light : image::indices_of(changed, change.name)) {
      image::apply(changed.lights[light], image::understand(change), changed.lumen_per_watt);
    }
  }
  mix = std::move(changed);
}

}  // namespace photile
