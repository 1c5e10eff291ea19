// What the kernels of kernels/structures are compiled with and given, of the structure they search.
#pragma once

#include "device/launch.hpp"
#include "maps/map_page.hpp"
#include "photile/photon_maps.hpp"

namespace photile::maps {

/// Sets the symbol that kernels/structures/query.clh knows the structure by.
inline void set_structure_defines(device::Defines& defines, MapStructure structure) {
  switch (structure) {
    case MapStructure::kdtree_left_balanced:
      defines.set("LEFT_BALANCED");
      break;
    case MapStructure::wide_bvh:
      defines.set("WIDE_BVH");
      break;
    case MapStructure::hashed_grid:
      defines.set("HASHED_GRID");
      break;
    default:
      defines.set("KDTREE");
      if (structure == MapStructure::kdtree_2d) defines.set("TREE_2D");
  }
}

/// Sets STRUCTURE_ARGUMENTS of kernels/structures/search.clh.
inline void set_structure_arguments(device::Launch& launch, const MapPage& page) {
  launch.set("entry_count", page.entry_count)
      .set("root", page.tree_root)
      .set("frames", page.grids)
      .set("nodes", page.nodes)
      .set("cell_start", page.cell_start);
}

}  // namespace photile::maps
