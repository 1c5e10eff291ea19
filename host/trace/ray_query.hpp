// Questions to a RayScene, for rooms that do not know Embree. Thread-safe; the caller's thread must
// flush denormals (flush_denormals.hpp).
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "photile/ray_scene.hpp"
#include "trace/surface.hpp"
#include "trace/triangle_hit.hpp"

namespace photile::trace {

/// Nearest hit of the ray, or nothing. A ray with a NaN or infinity hits nothing.
std::optional<TriangleHit> intersect(const RayScene& rays, const glm::vec3& origin,
                                     const glm::vec3& direction);

/// Whether a surface of any material cuts the straight line between two points.
bool occluded(const RayScene& rays, const glm::vec3& from, const glm::vec3& to);

/// What one surface lets through without a bend, per channel.
///   direction   of the ray that meets it there, unit
glm::vec3 transmittance(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction);

/// What the straight line between two points lets through, per channel: black behind a surface that
/// bends or stops light, the product of their transmittances behind panes of thin glass and
/// surfaces with holes.
glm::vec3 transmittance(const RayScene& rays, const glm::vec3& from, const glm::vec3& to);

}  // namespace photile::trace
