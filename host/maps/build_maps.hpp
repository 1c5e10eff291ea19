// Drives the build kernels.
#pragma once

#include "maps/map_store.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"

namespace photile::maps {

/// Builds one map per sided triangle or side of a patch: uniform grids, kd-trees, or plain lists of
/// photons. Fills the pages and statistics of `store`, whose device, needs and parameters are set.
void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          const NeighbourGroups& groups, Progress& progress);

/// Builds one kd-tree over all photons. Errors: DeviceError when they do not fit in one buffer.
void build_global_map(MapStore& store, const Scene& scene, const Photons& photons);

}  // namespace photile::maps
