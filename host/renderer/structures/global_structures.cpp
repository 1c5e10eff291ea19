#include "structures/global_structures.hpp"

#include <cassert>

#include "maps/other_structures.hpp"

namespace photile::maps {

void build_global_structure(const MapStore& store, const Photons& photons, MapPage& page) {
  device::Context& context = device::context_of(*store.device);
  const auto take = [&](const OrderedPoints& built) {
    page.entry_photon = context.upload(std::span(built.order), "photon references");
    page.nodes = context.upload(std::span(built.words), "nodes");
    page.node_count = built.nodes;
  };
  switch (store.parameters.structure) {
    case MapStructure::kdtree_global:
      build_global_tree(context, photons, page);
      break;
    case MapStructure::kdtree_left_balanced:
      take(build_left_balanced(photons.position));
      break;
    case MapStructure::wide_bvh:
      take(build_wide_bvh(photons.position));
      break;
    case MapStructure::hashed_grid:
      build_hashed_grid(store, photons, page);
      break;
    case MapStructure::uniform_grid:
    case MapStructure::kdtree_2d:
    case MapStructure::kdtree_3d:
    case MapStructure::brute_force:
      assert(false && "a structure of each map");
  }
}

}  // namespace photile::maps
