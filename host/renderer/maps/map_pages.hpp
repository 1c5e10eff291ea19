// Which maps share a page of the device's memory.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "maps/map_tiling.hpp"

namespace photile::maps {

/// Maps [first, last) with their photons, or a tile of the single map `first`.
struct MapRange {
  std::uint32_t first = 0, last = 0;
  std::uint64_t entries = 0;
  std::optional<Rectangle> tile{};  ///< of the map's MapTiling
};

/// How large a page may be.
struct PageLimits {
  std::uint64_t largest_buffer = 0;  ///< bytes; no buffer is larger
  /// Bytes that the page is to take together.
  std::uint64_t page_bytes = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t bytes_per_entry = 0;  ///< of page_bytes
  std::uint64_t bytes_per_map = 0;    ///< of page_bytes

  /// Three planes of floats are the largest buffer, and kernels index them in 32 bits.
  std::uint64_t most_entries() const;
  /// What a page takes. `cells`: that it has beside those that bytes_per_entry expects.
  std::uint64_t bytes(std::uint64_t entries, std::uint64_t maps, std::uint64_t cells = 0) const;
  /// Whether a page keeps to all limits.
  bool fit(std::uint64_t entries, std::uint64_t maps, std::uint64_t cells = 0) const;
};

/// Splits the maps into pages; maps without photons at either end of a page are left out. A map
/// that does not keep to the limits has a page of its own. `map_count`: photons per map.
std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits);

/// The maps with photons of `range` in two parts of about as many entries; nothing where there is
/// only one map.
std::optional<std::pair<MapRange, MapRange>> halves_of(const MapRange& range,
                                                       std::span<const std::uint32_t> map_count);

}  // namespace photile::maps
