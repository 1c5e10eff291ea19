// The program of the build.
#pragma once

#include "device/kernel_set.hpp"
#include "maps/map_store.hpp"

namespace photile::maps {

/// The kernels that build the maps of `store`, specialised by what its scene needs and by whether
/// its maps serve several triangles (`patches`).
device::KernelSet build_kernels(const MapStore& store, bool patches);

/// Those that pages need which hold a tile of a map.
device::KernelSet tile_kernels(const MapStore& store);

}  // namespace photile::maps
