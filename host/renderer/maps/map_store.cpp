#include "maps/map_store.hpp"

namespace photile::maps {

std::vector<std::uint32_t> MapStore::maps_of(const PrimaryHits& hits, std::size_t first,
                                             std::size_t count) const {
  const auto begin = hits.sided_triangle.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<std::uint32_t> maps(begin, begin + static_cast<std::ptrdiff_t>(count));
  if (!map_of.empty()) {
    for (std::uint32_t& map : maps) map = map_of[map];
  }
  if (tilings.empty()) return maps;
  for (std::size_t i = 0; i < count; ++i) {
    const auto tiling = tilings.find(maps[i]);
    if (tiling != tilings.end()) maps[i] = tiling->second.map_at(hits.position[first + i]);
  }
  return maps;
}

}  // namespace photile::maps
