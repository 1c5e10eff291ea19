// Pages of photon maps: the photons of a run of maps and the grids that find them, as they lie on
// the device; the symbols that tell kernels the contents of photon records; and which maps share a
// page, which is cut where it is too large.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

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
/// docs/kernels/data.md, "Records".
std::uint32_t bytes_per_record(const SceneNeeds& needs);

/// LIGHT_BYTES and GLOSSY, each where the scene needs it.
void set_record_defines(device::Defines& defines, const SceneNeeds& needs);

/// Maps [first, last) with their photons.
struct MapRange {
  std::uint32_t first = 0, last = 0;
  std::uint64_t records = 0;
};

/// How large a page may be.
struct PageLimits {
  std::uint64_t largest_buffer = 0;  ///< bytes; no buffer is larger
  /// Bytes that the page is to take together.
  std::uint64_t page_bytes = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t bytes_per_record = 0;  ///< of page_bytes
  std::uint64_t bytes_per_map = 0;     ///< of page_bytes

  /// Three planes of floats are the largest buffer, and kernels index them in 32 bits.
  std::uint64_t most_records() const;
  /// What a page takes.
  std::uint64_t bytes(std::uint64_t records, std::uint64_t maps) const;
  /// Whether a page keeps to all limits.
  bool fit(std::uint64_t records, std::uint64_t maps) const;
};

/// Splits the maps into pages; maps without photons at either end of a page are left out. A map
/// that exceeds the limits has its own page. `map_count`: photons per map.
std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits);

/// The maps with photons of `range` in two parts of about as many records; nothing where there is
/// only one map.
std::optional<std::pair<MapRange, MapRange>> halves_of(const MapRange& range,
                                                       std::span<const std::uint32_t> map_count);

/// Pages are cut between maps.
class PageQueue {
 public:
  using NameMap = std::function<std::string(std::uint32_t map)>;

  /// `map_count`: photons per map, for the life of the queue. `name_map` returns the name of a
  /// map's surface, for errors.
  PageQueue(std::span<const std::uint32_t> map_count, const PageLimits& limits, NameMap name_map);

  /// The next page, as far as possible within the limits; nothing at the end. Errors:
  /// DeviceMemoryError where one map needs a buffer larger than the largest.
  std::optional<MapRange> next();
  /// Whether `next` will return none, unless a page is cut or put back.
  bool empty() const { return pages_.empty(); }

  /// Cuts a page that did not fit, and puts its parts back; false where it is one map.
  bool cut(const MapRange& page);

  /// Device memory that a page is expected to take.
  std::uint64_t bytes(const MapRange& page) const;

  /// Puts the page back: it is the next one, unchanged.
  void put_back(const MapRange& page) { pages_.push_front(page); }

 private:
  std::span<const std::uint32_t> map_count_;
  PageLimits limits_;
  NameMap name_map_;
  std::deque<MapRange> pages_;
};

}  // namespace photile::maps
