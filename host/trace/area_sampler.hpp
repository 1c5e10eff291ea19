// Choice of a point on the triangles of an area light by what it emits.
#pragma once

#include <optional>
#include <vector>

#include "photile/scene.hpp"
#include "scene/emission_cells.hpp"
#include "trace/random_stream.hpp"
#include "trace/triangle_hit.hpp"

namespace photile::trace {

class AreaSampler {
 public:
  /// References are kept. Errors: InputError for a light whose triangles have no area.
  AreaSampler(const Scene& scene, const Light& light);

  /// A point of the light: uniformly, or of a textured light about in proportion to its luminance.
  /// Uses all words.
  TriangleHit sample(const RandomBlock& random) const;
  /// Of `sample` at a point of the light, per square metre of one side.
  double density(const TriangleHit& where) const;

 private:
  const Light* light_;
  std::vector<double> area_up_to_;                ///< area of the triangles up to and with this one
  std::optional<scene_io::EmissionCells> cells_;  ///< of a textured light
};

}  // namespace photile::trace
