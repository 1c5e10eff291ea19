// Solid glass that encloses nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/scene.hpp"

namespace photile::scene {

/// Per material: edges of its triangles that no other triangle of solid glass touches, so that the
/// glass ends in the open there. 0 for all but solid glass. Solids may consist of several meshes
/// and materials, whose corners need not be welded, nor meet: an edge is touched where its middle
/// is, to a millionth of the scene's size.
std::vector<std::uint32_t> open_edges_of_glass(const Scene& scene);

}  // namespace photile::scene
