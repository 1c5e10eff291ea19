#include "maps/map_pages.hpp"

#include <algorithm>

#include "maps/map_page.hpp"

namespace photile::maps {

std::uint64_t PageLimits::most_entries() const {
  const std::uint64_t floats = std::min<std::uint64_t>(largest_buffer / sizeof(float),
                                                       std::numeric_limits<std::uint32_t>::max());
  return std::max<std::uint64_t>(floats / 3, most_entry_padding) - most_entry_padding;
}

std::uint64_t PageLimits::bytes(std::uint64_t entries, std::uint64_t maps,
                                std::uint64_t cells) const {
  constexpr std::uint64_t bytes_per_cell = sizeof(std::uint32_t);
  return entries * bytes_per_entry + maps * bytes_per_map + cells * bytes_per_cell;
}

bool PageLimits::fit(std::uint64_t entries, std::uint64_t maps, std::uint64_t cells) const {
  const std::uint64_t most_cells = std::min(largest_buffer / sizeof(std::uint32_t), max_items) - 2;
  return entries <= most_entries() && maps <= largest_buffer / sizeof(PhotileGrid) &&
         cells <= most_cells && bytes(entries, maps, cells) <= page_bytes;
}

std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits) {
  std::vector<MapRange> pages;
  for (std::uint32_t map = 0; map < map_count.size(); ++map) {
    const std::uint64_t entries = map_count[map];
    if (entries == 0) continue;
    if (pages.empty() ||
        !limits.fit(pages.back().entries + entries, map + 1 - pages.back().first)) {
      pages.push_back({map, map, 0});
    }
    pages.back().last = map + 1;
    pages.back().entries += entries;
  }
  return pages;
}

std::optional<std::pair<MapRange, MapRange>> halves_of(const MapRange& range,
                                                       std::span<const std::uint32_t> map_count) {
  MapRange first, second;
  for (std::uint32_t map = range.first; map < range.last; ++map) {
    const std::uint64_t entries = map_count[map];
    if (entries == 0) continue;
    // The first part takes maps up to the middle, one at least.
    const bool to_first = first.entries == 0 || 2 * (first.entries + entries) <= range.entries;
    MapRange& part = to_first && second.entries == 0 ? first : second;
    if (part.entries == 0) part.first = map;
    part.last = map + 1;
    part.entries += entries;
  }
  if (second.entries == 0) return std::nullopt;
  return std::pair(first, second);
}

}  // namespace photile::maps
