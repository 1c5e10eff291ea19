#include "tools/view/light_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "photile/errors.hpp"

namespace photile::view {
namespace {

/// Tints a light of the mix. Returns whether it can have that colour.
bool tint(LightMix& mix, const LightControl& control) {
  try {
    const std::string value =
        control.kelvin > 0 ? fmt::format("{:.6g}K", control.kelvin) : hex_of(*control.color);
    change_lights(mix, {{control.name, value}});
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

}  // namespace

std::string hex_of(const glm::vec3& srgb) {
  const auto byte = [](float value) {
    return static_cast<int>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(srgb.r), byte(srgb.g), byte(srgb.b));
}

LightBoard::LightBoard(LightMix scene) : scene_(std::move(scene)) { reset(); }

void LightBoard::reset() {
  controls_.clear();
  for (const MixedLight& light : scene_.lights) {
    LightControl control;
    control.name = light.name;
    control.members = light.members;
    control.unit = light.unit;
    control.power = control.scene_power = light.power;
    controls_.push_back(std::move(control));
  }
}

LightMix LightBoard::mix() const {
  const bool any_solo = std::any_of(controls_.begin(), controls_.end(),
                                    [](const LightControl& control) { return control.solo; });
  LightMix result = scene_;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const LightControl& control = controls_[i];
    if (control.tinted()) tint(result, control);
    const bool lit = any_solo ? control.solo : control.on;
    result.lights[i].power = lit ? control.power : 0;
  }
  return result;
}

std::vector<std::string> LightBoard::refused() const {
  LightMix scratch = scene_;
  std::vector<std::string> names;
  for (const LightControl& control : controls_) {
    if (control.tinted() && !tint(scratch, control)) names.push_back(control.name);
  }
  return names;
}

}  // namespace photile::view
