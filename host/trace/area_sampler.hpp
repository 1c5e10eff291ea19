// Uniform choice of a point on the triangles of an area light.
#pragma once

#include <vector>

#include "photile/scene.hpp"
#include "trace/random_stream.hpp"
#include "trace/triangle_hit.hpp"

namespace photile::trace {

class AreaSampler {
 public:
  /// References are kept. Errors: InputError for a light whose triangles have no area.
  AreaSampler(const Scene& scene, const Light& light);

  /// A point of the light, density 1 / area() on either side. Uses all words.
  TriangleHit sample(const RandomBlock& random) const;

  double area() const { return area_up_to_.back(); }  ///< of one side, square metres

 private:
  const Light* light_;
  std::vector<double> area_up_to_;  ///< area of the triangles up to and with this one
};

}  // namespace photile::trace
