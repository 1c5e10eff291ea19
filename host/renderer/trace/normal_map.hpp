// Normals that a texture turns: the normal textures of glTF 2.0 (section 3.9.3).
#pragma once

#include <glm/glm.hpp>

#include "photile/scene.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The unit normal that the material's normal texture gives in place of `smooth`, a unit normal on
/// the side of the point. Tangent and bitangent are those of the corners where the file has them,
/// interpolated; else the directions in which the texture's u grows and its v falls on the
/// triangle. They are made perpendicular to `smooth` on the front; on the back the same bump is
/// seen from behind. `smooth` itself where the corners have no tangents and the coordinates span no
/// area.
glm::vec3 mapped_normal(const Scene& scene, const SurfacePoint& point, const glm::vec3& smooth);

}  // namespace photile::trace
