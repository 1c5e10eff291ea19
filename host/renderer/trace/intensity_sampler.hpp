// Directions of photons from a lamp whose intensities were measured.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/scene.hpp"
#include "trace/lamp_axes.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

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
