// The lamps as a page sets them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"

namespace photile::view {

/// A light, or a group of lights under one slider.
struct LightControl {
  std::string name;
  PowerUnit unit = PowerUnit::lumen;
  double power = 0;  ///< in `unit`, when it is on
  bool on = true;
  std::optional<glm::vec3> color = {};  ///< sRGB in [0, 1] that tints it; none = the light's own
  double kelvin = 0;  ///< temperature of its colour, in place of `color`; 0 = none

  bool tinted() const { return color || kelvin > 0; }
};

/// One control per light, or group, of the scene; patches of a sky have none, since the hour sets
/// them.
class LightBoard {
 public:
  explicit LightBoard(LightMix scene);

  std::vector<LightControl>& controls() { return controls_; }
  const std::vector<LightControl>& controls() const { return controls_; }

  /// What the controls make of the scene's lights. A colour that a light cannot have (it has none
  /// of a primary) leaves it as it was.
  LightMix mix() const;

  double lumen_per_watt() const { return scene_.lumen_per_watt; }

 private:
  LightMix scene_;
  std::vector<std::size_t> lights_;  ///< of the controls: into the scene's
  std::vector<LightControl> controls_;
};

/// "#rrggbb" of an sRGB colour in [0, 1].
std::string hex_of(const glm::vec3& srgb);

}  // namespace photile::view
