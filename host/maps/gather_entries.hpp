// Copies photon records into the order of a page's entries.
#pragma once

#include "device/kernel_set.hpp"
#include "maps/map_store.hpp"
#include "maps/photon_pages.hpp"

namespace photile::maps {

/// `build`: see build_kernels. Before: page.entry_count and page.entry_photon are set. After: the
/// other entry buffers that the scene needs are filled.
///   normals   3 floats per sided triangle, where the entries keep normals; else null
///   gaps      whether there are entries without a photon, as in tiles
void gather_entries(const device::KernelSet& build, const SceneNeeds& needs,
                    PhotonPages& photon_pages, const device::Buffer<float>* normals, bool gaps,
                    MapPage& page);

}  // namespace photile::maps
