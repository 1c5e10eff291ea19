// The photons of a run of maps, and what finds them, as they lie on the device; and the symbols by
// which kernels know what the photon records of a scene hold.
#pragma once

#include <cstdint>

#include "device/context.hpp"
#include "photile/device/constants.h"
#include "photile/device/grid.h"
#include "photile/scene.hpp"

namespace photile::maps {

static_assert(sizeof(PhotileGrid) == 20 * 4, "PhotileGrid must have no padding");

/// What a page covers: maps [first_map, last_map). A map is an oriented face's or one side of a
/// patch's.
struct PageExtent {
  std::uint32_t first_map = 0, last_map = 0;
  std::uint32_t record_count = 0;
  std::uint32_t record_stride = 0;  ///< distance of planes: record_count and padding
  std::uint32_t cell_count = 0;
};

/// The arrays of a page. None is larger than the device's largest allocation; which of them exist
/// depends on the scene's needs.
struct PageBuffers {
  // Photon records: the photons of each map, cell by cell, in ascending order within a cell.
  device::Buffer<std::uint32_t> record_photon;  ///< index into Photons
  device::Buffer<float> record_position;        ///< planes x, y, z
  device::Buffer<float> record_flux;            ///< planes r, g, b
  device::Buffer<std::uint8_t> record_light;    ///< bytes_per_light(needs) each
  device::Buffer<float> record_incoming;        ///< planes x, y, z; only in glossy scenes
  /// Planes x, y, z of the photon's oriented face; only in pages with a map of triangles
  /// of different normals.
  device::Buffer<float> record_normal;

  device::Buffer<PhotileGrid> grids;         ///< per map
  device::Buffer<std::uint32_t> cell_start;  ///< per cell, and the end of the last, twice

  std::uint64_t device_bytes() const;
};

/// Calls visit(buffer) for each, always in the same order.
template <class Buffers, class Visit>
void for_each_buffer(Buffers& buffers, Visit visit) {
  visit(buffers.record_photon);
  visit(buffers.record_position);
  visit(buffers.record_flux);
  visit(buffers.record_light);
  visit(buffers.record_incoming);
  visit(buffers.record_normal);
  visit(buffers.grids);
  visit(buffers.cell_start);
}

struct MapPage : PageExtent, PageBuffers {};

/// Cells of a page at most, and photons: kernels step over them in 32 bits.
inline constexpr std::uint64_t max_items = std::uint64_t{1} << 31;

/// The widest vector, in floats, by which photon records are read, and which may reach this far
/// beyond the last.
inline constexpr std::uint32_t record_padding = PHOTILE_MOST_LANES;
inline constexpr std::uint32_t most_record_padding = 2 * record_padding - 1;

/// Distance of the planes of `records` records: a multiple of the widest vector, so that aligned
/// vectors of any plane are one cache line.
constexpr std::uint32_t record_stride(std::uint32_t records) {
  return (records + most_record_padding) / record_padding * record_padding;
}

/// Bytes of a record's light: 0 with one light, 1 up to 256, else 2.
std::uint32_t bytes_per_light(const SceneNeeds& needs);

/// Bytes of a record in all of its buffers, without the normals of normal-filtered maps:
/// docs/kernels.md, "Records".
std::uint32_t bytes_per_record(const SceneNeeds& needs);

/// LIGHT_BYTES and GLOSSY, each where the scene needs it.
void set_record_defines(device::Defines& defines, const SceneNeeds& needs);

}  // namespace photile::maps
