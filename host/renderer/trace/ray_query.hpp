// Questions to a RayScene, for rooms that do not know Embree. Thread-safe; the caller's thread must
// flush denormals (flush_denormals.hpp).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "photile/ray_scene.hpp"
#include "trace/surface.hpp"
#include "trace/triangle_hit.hpp"

namespace photile::trace {

/// Nearest hit of the ray, or nothing. A ray with a NaN or infinity hits nothing.
std::optional<TriangleHit> intersect(const RayScene& rays, const glm::vec3& origin,
                                     const glm::vec3& direction);

/// Whether a surface of any material cuts the straight line between two points.
bool occluded(const RayScene& rays, const glm::vec3& from, const glm::vec3& to);

/// A straight line from a surface to a lamp, say.
struct LineOfSight {
  glm::vec3 from, to;
};

/// The same of lines that begin close together: packets of sixteen, twice as fast. The answer for a
/// line may depend, in its roundings, on those beside it.
///   hidden   of each line: set to 1, or 0
void occluded(const RayScene& rays, std::span<const LineOfSight> lines,
              std::span<std::uint8_t> hidden);

/// What one surface lets through without a bend, per channel.
///   direction   of the ray that meets it there, unit
glm::vec3 transmittance(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction);

/// What the straight line between two points lets through, per channel: black behind a surface that
/// bends or stops light, the product of their transmittances behind panes of thin glass and
/// surfaces with holes.
glm::vec3 transmittance(const RayScene& rays, const glm::vec3& from, const glm::vec3& to);

}  // namespace photile::trace
