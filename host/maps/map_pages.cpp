#include "maps/map_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "maps/map_store.hpp"
#include "photile/errors.hpp"

namespace photile::maps {

std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     std::uint64_t max_bytes) {
  // Three planes of floats are the largest buffer; entry indices are 32 bits wide.
  constexpr std::uint64_t bytes_per_entry = 3 * sizeof(float);
  const std::uint64_t max_entries =
      std::min<std::uint64_t>(max_bytes / bytes_per_entry,
                              std::numeric_limits<std::uint32_t>::max() / 3) -
      entry_padding;
  const std::uint64_t max_maps = max_bytes / sizeof(PhotileGrid);

  std::vector<MapRange> pages;
  for (std::uint32_t map = 0; map < map_count.size(); ++map) {
    const std::uint64_t entries = map_count[map];
    if (entries == 0) continue;
    if (entries > max_entries) {
      throw DeviceError(
          fmt::format("the photon map of triangle {} has {} photons, more than the {} that the "
                      "device's largest "
                      "buffer holds; use fewer photons or a smaller radius",
                      map / 2, entries, max_entries));
    }
    const bool starts_page = pages.empty() || pages.back().entries + entries > max_entries ||
                             map - pages.back().first >= max_maps;
    if (starts_page) pages.push_back({map, map, 0});
    pages.back().last = map + 1;
    pages.back().entries += entries;
  }
  return pages;
}

}  // namespace photile::maps
