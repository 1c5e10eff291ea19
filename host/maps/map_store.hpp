// Photon maps as they lie on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/context.hpp"
#include "photile/device/grid.h"
#include "photile/device/kdtree.h"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

static_assert(sizeof(PhotileGrid) == 17 * 4, "PhotileGrid must have no padding");
static_assert(sizeof(PhotileTreeNode) == 4 * 4, "PhotileTreeNode must have no padding");

/// The photons of the maps of sided triangles [first_map, last_map), and what finds them. No buffer
/// is larger than the device's largest allocation. Which buffers exist depends on the structure and
/// on the scene's needs.
struct MapPage {
  std::uint32_t first_map = 0, last_map = 0;

  // Entries: the photons of each map, in ascending order within a grid's cell or in the order of
  // the leaves of its tree.
  std::uint32_t entry_count = 0;
  std::uint32_t entry_stride = 0;              ///< distance of planes: entry_count and padding
  device::Buffer<std::uint32_t> entry_photon;  ///< index into Photons
  device::Buffer<float> entry_position;        ///< planes x, y, z
  device::Buffer<float> entry_flux;            ///< planes r, g, b
  device::Buffer<std::uint16_t> entry_light;   ///< only with several lights
  device::Buffer<float> entry_incoming;        ///< planes x, y, z; only in glossy scenes
  device::Buffer<float> entry_normal;          ///< planes x, y, z; only in a global tree

  // Grids; in the plane of its triangle also the frame of a 2D tree.
  std::uint32_t cell_count = 0;
  device::Buffer<PhotileGrid> grids;         ///< per map
  device::Buffer<std::uint32_t> cell_start;  ///< per cell, and the end of the last

  // Trees.
  device::Buffer<std::uint32_t> tree_root;  ///< per map; none without photons
  device::Buffer<PhotileTreeNode> tree_nodes;

  std::uint64_t device_bytes() const;
};

/// The state behind PhotonMaps.
struct MapStore {
  Device* device = nullptr;
  SceneNeeds needs;
  PhotonMapParameters parameters;
  PhotonMapStatistics statistics;
  std::vector<MapPage> pages;        ///< ascending; maps without photons may lie in none
  double cos_angle = 0;              ///< of the largest angle between normals
  device::Buffer<float> map_normal;  ///< 3 per sided triangle; only for a global tree
};

/// Entries are read in vectors of up to 16 floats, which may reach this far beyond the last.
inline constexpr std::uint32_t entry_padding = 16;

/// Work-items of a group in every kernel of build and estimate.
inline constexpr std::size_t work_group_size = 64;

}  // namespace photile::maps
