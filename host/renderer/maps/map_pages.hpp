// Which maps share a page of the device's memory, and the pages that are still to be built, cut
// where they are too large.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
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

/// Maps that are cut into tiles, by their numbers.
using MapTilings = std::map<std::uint32_t, MapTiling>;

/// Pages of several maps are cut between maps, single maps into tiles. Tiles come after all whole
/// maps.
class PageQueue {
 public:
  using MakeTiling = std::function<MapTiling(std::uint32_t map)>;
  using NameMap = std::function<std::string(std::uint32_t map)>;

  /// `map_count`: photons per map, for the life of the queue. `make_tiling` counts the photons of a
  /// map on its grid; `name_map` says what a map serves, for errors.
  PageQueue(std::span<const std::uint32_t> map_count, const PageLimits& limits, MapTilings& tilings,
            MakeTiling make_tiling, NameMap name_map);

  /// The next page, as far as possible within the limits; nothing at the end. Errors: DeviceError
  /// where the photons within the radius of one point need a buffer larger than the largest.
  std::optional<MapRange> next();
  /// Whether `next` will return none, unless a page is cut or put back.
  bool empty() const { return pages_.empty(); }

  /// Cuts a page that did not fit, and puts its parts back; false where it cannot be cut.
  bool cut(const MapRange& page);

  /// Device memory that a page is expected to take.
  std::uint64_t bytes(const MapRange& page) const;

  /// The page is the next one, as it is.
  void put_back(const MapRange& page) { pages_.push_front(page); }

 private:
  std::uint64_t cells_of_tile(const MapRange& page) const;
  MapRange tile_of(std::uint32_t map, const Rectangle& tile) const;

  std::span<const std::uint32_t> map_count_;
  PageLimits limits_;
  MapTilings& tilings_;
  MakeTiling make_tiling_;
  NameMap name_map_;
  std::deque<MapRange> pages_;
};

}  // namespace photile::maps
