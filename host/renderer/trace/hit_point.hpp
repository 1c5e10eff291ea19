// The surface under a hit.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>

#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The point of its surface where a hit lies.
inline SurfacePoint point_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit) {
  const std::uint32_t sided = hits.sided_triangle[hit];
  return surface_point(
      scene, nearest_on_triangle(scene, triangle_of(sided), glm::dvec3(hits.position[hit])),
      side_of(sided));
}

/// How the surface reflects light against the ray of an eye that arrived there, smoothly shaded. A
/// Lambertian surface does not
/// ask where it is seen from: where nothing is glossy, hits do not say it, and any direction
/// serves.
inline OpaqueBsdf bsdf_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit,
                          const SurfacePoint& point) {
  OpaqueBsdf bsdf(scene, point, hits.outgoing.empty() ? -point.normal : -hits.outgoing[hit]);
  bsdf.shade_smoothly(scene, point);
  // Hits that are seen directly, where reflections alone are looked at.
  if (hits.diffuse_albedo[hit] == glm::vec3(0.0f)) bsdf.drop_diffuse();
  return bsdf;
}

}  // namespace photile::trace
