// Choice of a point on the triangles of an area light by what it emits.
#pragma once

#include <optional>
#include <vector>

#include "photile/scene.hpp"
#include "scene/emission_cells.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"
#include "trace/triangle_hit.hpp"

namespace photile::trace {

class AreaSampler {
 public:
  /// References are kept. Errors: InputError for a light whose triangles have no area.
  AreaSampler(const Scene& scene, const Light& light);

  /// A point of the light: uniformly, or of a textured light about in proportion to its luminance.
  /// Uses all words.
  TriangleHit sample(const RandomBlock& random) const;
  /// The same on the front of the surface.
  SurfacePoint sample_front(const RandomBlock& random) const;
  /// Uniformly on the front of triangle `number` of the light, which has no texture.
  SurfacePoint sample_front_of(std::size_t number, const RandomBlock& random) const;
  /// Of `sample` at a point of the light, per square metre of one side.
  double density(const TriangleHit& where) const;

 private:
  /// What `surface_point` finds of a triangle, for all points.
  struct Front {
    glm::dvec3 corner, along_u, along_v;
    glm::vec3 normal;
    float clearance;
    std::uint32_t side;
  };
  std::size_t chosen(const RandomBlock& random) const;

  const Scene* scene_;
  const Light* light_;
  std::vector<Front> fronts_;                  ///< of the triangles; none of a textured light
  std::vector<double> area_up_to_;             ///< area of the triangles up to and with this one
  std::optional<scene::EmissionCells> cells_;  ///< of a textured light
};

}  // namespace photile::trace
