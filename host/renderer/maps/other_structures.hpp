// What the build asks of a structure other than the uniform grid. host/renderer/structures has them,
// and their queries (estimate/query.hpp).
#pragma once

#include <cstdint>
#include <span>

#include "maps/map_store.hpp"
#include "photile/photons.hpp"

namespace photile::maps {

/// Whether maps of this structure are kd-trees per triangle.
bool is_tree(MapStructure structure);

/// One tree per map of the page, in its plane (kdtree_2d) or in space (kdtree_3d). Before: the
/// page's grids have one cell per map. After: page.entry_photon is in the order of the leaves.
/// `map_count`: photons per sided triangle. Maps are built in parallel.
void build_trees(device::Context& context, MapStructure structure, const Photons& photons,
                 std::span<const std::uint32_t> map_count, MapPage& page);

/// Builds the structure of `store`, which is global, for hits of maps [page.first_map,
/// page.last_map). After: page.entry_photon and what finds entries are set. Errors:
/// DeviceMemoryError.
void build_global_structure(const MapStore& store, const Photons& photons, MapPage& page);

}  // namespace photile::maps
