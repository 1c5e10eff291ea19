// The lamps as the viewer sets them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photile/light_mix.hpp"

namespace photile::view {

/// A light, or a group of lights under one slider.
struct LightControl {
  std::string name;
  std::vector<std::string> members;  ///< lights of a group; empty for a light alone
  PowerUnit unit = PowerUnit::lumen;
  double power = 0;        ///< in `unit`, when it is on
  double scene_power = 0;  ///< what the scene says
  bool on = true;
  bool solo = false;
  std::optional<glm::vec3> color;  ///< sRGB in [0, 1] that tints it; none = the light's own
  double kelvin = 0;               ///< temperature of its colour, in place of `color`; 0 = none

  bool tinted() const { return color || kelvin > 0; }
};

/// One control per layer of the picture. Changing one costs a sum over the layers, no light is
/// traced or estimated again.
class LightBoard {
 public:
  explicit LightBoard(LightMix scene);

  std::vector<LightControl>& controls() { return controls_; }
  const std::vector<LightControl>& controls() const { return controls_; }

  /// What the controls make of the scene's lights. While one or more are solo, the others are dark.
  /// A colour that a light cannot have (it has none of a primary) leaves it as it was: see
  /// `refused`.
  LightMix mix() const;

  double lumen_per_watt() const { return scene_.lumen_per_watt; }

  /// Names of lights whose colour `mix` could not set, for the panel to tell.
  std::vector<std::string> refused() const;

  /// All as the scene says.
  void reset();

 private:
  LightMix scene_;
  std::vector<LightControl> controls_;
};

/// "#rrggbb" of an sRGB colour in [0, 1].
std::string hex_of(const glm::vec3& srgb);

}  // namespace photile::view
