// Directions towards the surroundings, in proportion to their luminance.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// A row of the map by its luminance, then a texel of the row, then a direction uniformly over the
/// texel's solid angle (Pharr, Jakob and Humphreys, "Physically Based Rendering", 12.5).
class EnvironmentSampler {
 public:
  /// A reference is kept. `map` is not black.
  explicit EnvironmentSampler(const EnvironmentMap& map);

  /// In proportion to luminance times a factor, of the middle of each texel, >= 0.
  EnvironmentSampler(const EnvironmentMap& map,
                     const std::function<double(const glm::dvec3& direction)>& factor);
  /// Whether there is a direction to choose.
  bool empty() const { return !(row_up_to_.back() > 0); }

  struct Sample {
    glm::vec3 direction;  ///< unit, towards the surroundings
    glm::vec3 color;      ///< radiance / luminance of the texel
    float density;        ///< per steradian: luminance x factor / its integral over the sphere
  };
  Sample sample(const RandomBlock& random) const;
  float density(const glm::vec3& direction) const;

 private:
  /// Of a texel: luminance x factor.
  double weight(int column, int row) const;

  const EnvironmentMap* map_;
  std::vector<double> row_up_to_;  ///< luminance x solid angle of the rows up to and with this one
  std::vector<double> texel_up_to_;  ///< luminance of the texels of a row up to and with this one
};

}  // namespace photile::trace
