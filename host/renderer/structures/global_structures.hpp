// Structures over all photons, which every hit is answered from.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "maps/map_store.hpp"
#include "photile/photons.hpp"

namespace photile::maps {

/// Builds the structure of `store`, which is global, for hits of maps [page.first_map,
/// page.last_map). After: page.entry_photon and what finds entries are set. Errors:
/// DeviceMemoryError.
void build_global_structure(const MapStore& store, const Photons& photons, MapPage& page);

/// What a builder on the host makes.
struct OrderedPoints {
  std::vector<std::uint32_t> order;  ///< indices of points, in the order of the entries
  std::vector<std::uint32_t> words;  ///< of the nodes, as the kernels of the structure read them
  std::uint32_t nodes = 0;
};

/// A left-balanced kd-tree: kernels/structures/left_balanced.cl. Splits the widest axis of each
/// node's points; of points at one coordinate those of smaller indices are lower.
OrderedPoints build_left_balanced(std::span<const glm::vec3> points);

/// A hierarchy of boxes of eight: include/photile/device/wide_bvh.h. Points are halved along the
/// widest axis of their box, at the place that leaves all nodes and leaves but the last full.
OrderedPoints build_wide_bvh(std::span<const glm::vec3> points);

/// A hashed grid, built on the device: kernels/structures/build_hashed_grid.cl. Sets
/// page.cell_count, cell_start, entry_photon and nodes.
void build_hashed_grid(const MapStore& store, const Photons& photons, MapPage& page);

}  // namespace photile::maps
