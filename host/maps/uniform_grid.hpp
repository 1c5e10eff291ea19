// Photon maps as they lie on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/context.hpp"
#include "photile/device/grid.h"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

static_assert(sizeof(PhotileGrid) == 17 * 4, "PhotileGrid must have no padding");

/// The maps of sided triangles [first_map, last_map). No buffer is larger than the device's largest
/// allocation. Entries are the photons of each cell, cell after cell, in ascending photon order.
struct MapPage {
  std::uint32_t first_map = 0, last_map = 0;
  std::uint32_t entry_count = 0;
  std::uint32_t entry_stride = 0;  ///< distance of planes: entry_count and padding
  std::uint32_t cell_count = 0;

  device::Buffer<PhotileGrid> grids;           ///< per map
  device::Buffer<std::uint32_t> cell_start;    ///< per cell, and the end of the last
  device::Buffer<std::uint32_t> entry_photon;  ///< index into Photons
  device::Buffer<float> entry_position;        ///< planes x, y, z
  device::Buffer<float> entry_flux;            ///< planes r, g, b
  device::Buffer<std::uint16_t> entry_light;   ///< only with several lights
  device::Buffer<float> entry_incoming;        ///< planes x, y, z; only in glossy scenes

  std::uint64_t device_bytes() const;
};

/// The state behind PhotonMaps.
struct UniformGrid {
  Device* device = nullptr;
  SceneNeeds needs;
  PhotonMapParameters parameters;
  PhotonMapStatistics statistics;
  std::vector<MapPage> pages;  ///< ascending, without gaps; pages without photons are left out
};

/// Entries are read in vectors of up to 16 floats, which may reach this far beyond the last.
inline constexpr std::uint32_t entry_padding = 16;

/// Work-items of a group in every kernel of build and estimate.
inline constexpr std::size_t work_group_size = 64;

}  // namespace photile::maps
