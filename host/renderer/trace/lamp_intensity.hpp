// What lamps without surface send in a direction, and where their photons go.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/random_stream.hpp"
#include "trace/spot_falloff.hpp"

namespace photile::trace {

/// A lamp shines along the -z axis of its own space.
struct LampAxes {
  explicit LampAxes(const Light& light)
      : x(light.x_axis), z(-glm::dvec3(light.direction)), y(glm::cross(z, x)) {}

  glm::dvec3 to_world(const glm::dvec3& v) const { return x * v.x + y * v.y + z * v.z; }
  glm::dvec3 to_lamp(const glm::dvec3& v) const {
    return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
  }

  glm::dvec3 x, z, y;  ///< unit; y needs the others
};

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

/// Directions of photons from a lamp whose intensities were measured.
class IntensitySampler {
 public:
  /// References are kept. `light` has a distribution that emits something.
  IntensitySampler(const Scene& scene, const Light& light);

  /// A direction in the scene, density intensity / flux: a cell of the grid by its flux, and in it
  /// a direction by rejection, which takes 4 tries at most on average.
  glm::vec3 sample(const RandomStream& random) const;

 private:
  const IntensityDistribution* distribution_;
  LampAxes axes_;
  std::vector<double> flux_up_to_;  ///< of the cells up to and with this one, column by column
};

}  // namespace photile::trace
