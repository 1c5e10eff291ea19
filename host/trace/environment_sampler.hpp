// Directions towards the surroundings, in proportion to their luminance.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/environment_map.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// A row of the map by its luminance, then a texel of the row, then a direction uniformly over the
/// texel's solid angle (Pharr, Jakob and Humphreys, "Physically Based Rendering", 12.5).
class EnvironmentSampler {
 public:
  /// A reference is kept. `map` is not black.
  explicit EnvironmentSampler(const EnvironmentMap& map);

  struct Sample {
    glm::vec3 direction;  ///< unit, towards the surroundings
    glm::vec3 color;      ///< radiance / luminance of the texel
    float density;        ///< per steradian: luminance / its integral over the sphere
  };
  Sample sample(const RandomBlock& random) const;
  float density(const glm::vec3& direction) const;

 private:
  const EnvironmentMap* map_;
  std::vector<double> row_up_to_;  ///< luminance x solid angle of the rows up to and with this one
  std::vector<double> texel_up_to_;  ///< luminance of the texels of a row up to and with this one
};

}  // namespace photile::trace
