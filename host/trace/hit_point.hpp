// The surface under a hit.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "photile/primary_hits.hpp"
#include "photile/scene.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The point of its surface where a hit lies.
inline SurfacePoint point_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit) {
  const std::uint32_t sided = hits.sided_triangle[hit];
  return surface_point(
      scene, nearest_on_triangle(scene, triangle_of(sided), glm::dvec3(hits.position[hit])),
      side_of(sided));
}

/// Unit direction of the ray that arrived there. A Lambertian surface does not ask where it is seen
/// from: where nothing is glossy, hits do not say it, and any direction serves.
inline glm::vec3 arrival_of(const PrimaryHits& hits, std::size_t hit, const SurfacePoint& point) {
  return hits.outgoing.empty() ? -point.normal : -hits.outgoing[hit];
}

}  // namespace photile::trace
