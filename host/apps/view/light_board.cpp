#include "view/light_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "loading/surroundings.hpp"
#include "photile/errors.hpp"

namespace photile::view {
namespace {

void tint(LightMix& mix, const LightControl& control) {
  try {
    const std::string value =
        control.kelvin > 0 ? fmt::format("{:.6g}K", control.kelvin) : hex_of(*control.color);
    change_lights(mix, {{control.name, value}});
  } catch (const UsageError&) {  // it cannot have that colour
  }
}

}  // namespace

std::string hex_of(const glm::vec3& srgb) {
  const auto byte = [](float value) {
    return static_cast<int>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(srgb.r), byte(srgb.g), byte(srgb.b));
}

LightBoard::LightBoard(LightMix scene) : scene_(std::move(scene)) {
  const std::vector<std::uint32_t> patch = loading::patch_of_layers(scene_);
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    if (patch[i] != none) continue;
    const MixedLight& light = scene_.lights[i];
    lights_.push_back(i);
    controls_.push_back({.name = light.name, .unit = light.unit, .power = light.power});
  }
}

LightMix LightBoard::mix() const {
  LightMix result = scene_;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const LightControl& control = controls_[i];
    if (control.tinted()) tint(result, control);
    result.lights[lights_[i]].power = control.on ? control.power : 0;
  }
  return result;
}

}  // namespace photile::view
