#include "maps/map_pages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "maps/map_page.hpp"
#include "photile/errors.hpp"

namespace photile::maps {
namespace {

/// Entries of a page at most: three planes of floats are the largest buffer, and kernels index them
/// in 32 bits.
std::uint64_t max_entries(std::uint64_t largest_buffer) {
  const std::uint64_t floats = std::min<std::uint64_t>(largest_buffer / sizeof(float),
                                                       std::numeric_limits<std::uint32_t>::max());
  return std::max<std::uint64_t>(floats / 3, most_entry_padding) - most_entry_padding;
}

}  // namespace

std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits, const Patches& patches) {
  const std::uint64_t most_entries = max_entries(limits.largest_buffer);
  const std::uint64_t most_maps = limits.largest_buffer / sizeof(PhotileGrid);
  const auto page_bytes = [&](std::uint64_t entries, std::uint64_t maps) {
    return entries * limits.bytes_per_entry + maps * limits.bytes_per_map;
  };

  std::vector<MapRange> pages;
  for (std::uint32_t map = 0; map < map_count.size(); ++map) {
    const std::uint64_t entries = map_count[map];
    if (entries == 0) continue;
    if (entries > most_entries) {
      throw DeviceError(
          fmt::format("the photon map of triangle {}{} has {} photons, more than the {} that the "
                      "device's largest buffer holds; use fewer photons, a smaller radius{}",
                      patches.empty() ? map / 2 : triangle_of(patches.of(map / 2).front()),
                      patches.empty() ? "" : " and its patch", entries, most_entries,
                      patches.empty() ? "" : " or --maps triangle"));
    }
    const auto fits = [&](const MapRange& page) {
      const std::uint64_t maps = map + 1 - page.first;
      return page.entries + entries <= most_entries && maps <= most_maps &&
             page_bytes(page.entries + entries, maps) <= limits.page_bytes;
    };
    if (pages.empty() || !fits(pages.back())) pages.push_back({map, map, 0});
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
