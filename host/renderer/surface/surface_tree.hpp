// A bounding volume hierarchy over pieces of surface, eight wide.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/device/surface.h"
#include "surface/unlit_sides.hpp"

namespace photile::surface {

/// Nodes in depth-first order, the root first; leaves as lists of pieces.
struct SurfaceTree {
  std::vector<PhotileSurfaceNode> nodes;
  std::vector<std::vector<std::uint32_t>> leaves;
};

/// Splits by the surface area heuristic over 16 bins of the boxes' centres (Wald 2007), and at the
/// median where that does not split the boxes. The same pieces give the same tree.
SurfaceTree build_surface_tree(const std::vector<SurfacePiece>& pieces);

}  // namespace photile::surface
