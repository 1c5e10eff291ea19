// What the kernels of kernels/structures are compiled with and given, of the structure they search.
#pragma once

#include "device/launch.hpp"
#include "maps/map_page.hpp"
#include "photile/photon_maps.hpp"

namespace photile::maps {

/// The kernels that search the structure.
inline const char* kernel_file(MapStructure structure) {
  switch (structure) {
    case MapStructure::kdtree_left_balanced:
      return "structures/left_balanced.cl";
    case MapStructure::wide_bvh:
      return "structures/wide_bvh.cl";
    case MapStructure::hashed_grid:
      return "structures/hashed_grid.cl";
    default:
      return "structures/kdtree.cl";
  }
}

/// Sets the members of Structure in kernels/structures/search.clh.
inline void set_structure_arguments(device::Launch& launch, const MapPage& page) {
  launch.set("entry_count", page.entry_count)
      .set("root", page.tree_root)
      .set("frames", page.grids)
      .set("nodes", page.nodes)
      .set("cell_start", page.cell_start);
}

}  // namespace photile::maps
