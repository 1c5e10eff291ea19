// Which maps share a page of the device's memory.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "photile/patches.hpp"

namespace photile::maps {

/// Maps [first, last) with their photons.
struct MapRange {
  std::uint32_t first = 0, last = 0;
  std::uint64_t entries = 0;
};

/// How large a page may be.
struct PageLimits {
  std::uint64_t largest_buffer = 0;  ///< bytes; no buffer is larger
  /// Bytes that the page is to take together. A map that is larger has a page of its own.
  std::uint64_t page_bytes = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t bytes_per_entry = 0;  ///< of page_bytes
  std::uint64_t bytes_per_map = 0;    ///< of page_bytes
};

/// Splits the maps into pages; maps without photons at either end of a page are left out.
/// `map_count`: photons per map. `patches` name the map in the error.
/// Errors: DeviceError when a single map alone needs a buffer larger than the largest.
std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits, const Patches& patches = {});

/// The maps with photons of `range` in two parts of about as many entries; nothing where there is
/// only one map.
std::optional<std::pair<MapRange, MapRange>> halves_of(const MapRange& range,
                                                       std::span<const std::uint32_t> map_count);

}  // namespace photile::maps
