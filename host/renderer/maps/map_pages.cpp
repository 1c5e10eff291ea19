#include "maps/map_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "maps/map_page.hpp"
#include "photile/errors.hpp"

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

PageQueue::PageQueue(std::span<const std::uint32_t> map_count, const PageLimits& limits,
                     MapTilings& tilings, MakeTiling make_tiling, NameMap name_map)
    : map_count_(map_count),
      limits_(limits),
      tilings_(tilings),
      make_tiling_(std::move(make_tiling)),
      name_map_(std::move(name_map)) {
  for (const MapRange& page : plan_map_pages(map_count, limits)) pages_.push_back(page);
}

std::optional<MapRange> PageQueue::next() {
  while (!pages_.empty()) {
    const MapRange page = pages_.front();
    pages_.pop_front();
    if (page.entries == 0) continue;  // a tile without photons near
    const bool fits = limits_.fit(page.entries, page.last - page.first, cells_of_tile(page));
    if (!fits && cut(page)) continue;
    const std::uint64_t most = limits_.most_entries();
    if (page.entries > most) {
      throw DeviceMemoryError(fmt::format(
          "the photon map of {} has {} photons within the radius of one point, more than the {} "
          "that the device's largest buffer holds; use fewer photons, a smaller radius or more "
          "passes, or a larger memory limit if one is set",
          name_map_(page.first), page.entries, most));
    }
    return page;
  }
  return std::nullopt;
}

bool PageQueue::cut(const MapRange& page) {
  if (page.tile) {
    const auto halves = tilings_.at(page.first).halves(*page.tile);
    if (!halves) return false;
    pages_.push_front(tile_of(page.first, halves->second));
    pages_.push_front(tile_of(page.first, halves->first));
    return true;
  }
  if (const auto halves = halves_of(page, map_count_)) {
    pages_.push_front(halves->second);
    pages_.push_front(halves->first);
    return true;
  }
  const MapTiling tiling = make_tiling_(page.first);
  const auto halves = tiling.halves(tiling.whole());
  if (!halves) return false;
  tilings_.insert_or_assign(page.first, tiling);
  pages_.push_back(tile_of(page.first, halves->first));
  pages_.push_back(tile_of(page.first, halves->second));
  return true;
}

std::uint64_t PageQueue::bytes(const MapRange& page) const {
  return limits_.bytes(page.entries, page.last - page.first, cells_of_tile(page));
}

std::uint64_t PageQueue::cells_of_tile(const MapRange& page) const {
  if (!page.tile) return 0;
  const MapTiling& tiling = tilings_.at(page.first);
  return std::uint64_t{tiling.cells(*page.tile).height()} * tiling.grid().columns;
}

MapRange PageQueue::tile_of(std::uint32_t map, const Rectangle& tile) const {
  return {map, map + 1, tilings_.at(map).entries(tile), tile};
}

}  // namespace photile::maps
