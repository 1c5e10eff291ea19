// Which maps share a page of the device's memory, and the pages that are still to be built, cut
// where they are too large.
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

namespace photile::maps {

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

  /// `map_count`: photons per map, for the life of the queue. `name_map` says what a map serves,
  /// for errors.
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

  /// The page is the next one, as it is.
  void put_back(const MapRange& page) { pages_.push_front(page); }

 private:
  std::span<const std::uint32_t> map_count_;
  PageLimits limits_;
  NameMap name_map_;
  std::deque<MapRange> pages_;
};

}  // namespace photile::maps
