// What lamps without surface send in a direction.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/scene.hpp"
#include "trace/lamp_axes.hpp"
#include "trace/spot_falloff.hpp"

namespace photile::trace {

/// Candela of a point or spot light in a unit direction, away from it, for each lumen that it
/// emits.
inline double candela_per_lumen(const Scene& scene, const Light& lamp,
                                const glm::dvec3& direction) {
  if (lamp.distribution != none) {
    const IntensityDistribution& distribution = scene.distributions[lamp.distribution];
    return distribution.intensity(LampAxes(lamp).to_lamp(direction)) / distribution.flux();
  }
  if (lamp.kind == LightKind::spot) {
    const SpotFalloff spot(lamp);
    return spot.at(glm::dot(direction, glm::dvec3(lamp.direction))) /
           (glm::two_pi<double>() * spot.integral());
  }
  return 0.25 * glm::one_over_pi<double>();
}

}  // namespace photile::trace
