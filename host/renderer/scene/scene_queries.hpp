// Queries of a scene: how far it reaches, which positions it can hold, which glass encloses
// nothing, and its hash.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "common/content_hash.hpp"
#include "geometry/box.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"

namespace photile::scene {

geometry::Box bounds_of(const Scene& scene);

/// The largest absolute coordinate of all vertices, metres: rounding is proportional to it.
float largest_coordinate(const Scene& scene);

/// Per material: edges of its triangles that no other triangle of solid glass touches, so that the
/// glass ends in the open there. 0 for all but solid glass. Solids may consist of several meshes
/// and materials, whose corners need not be welded, nor meet: an edge counts as touched if its
/// middle is, to a millionth of the scene's size.
std::vector<std::uint32_t> open_edges_of_glass(const Scene& scene);

/// Neither NaN, infinite nor beyond limits::max_coordinate.
inline bool within_limit(const glm::dvec3& position) {
  constexpr double most = limits::max_coordinate;
  return std::abs(position.x) <= most && std::abs(position.y) <= most &&
         std::abs(position.z) <= most;
}

/// Adds the geometry of surfaces and their reflection, without the texels of pictures.
void add_surfaces(const Scene& scene, ContentHash& hash);

/// Adds everything that light depends on: geometry, materials, texels, lights with their groups,
/// and the unit; not cameras or file names.
void add_scene(const Scene& scene, ContentHash& hash);

}  // namespace photile::scene
