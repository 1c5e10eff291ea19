// Which maps share a page of the device's memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace photile::maps {

/// Maps [first, last) with their photons.
struct MapRange {
  std::uint32_t first = 0, last = 0;
  std::uint64_t entries = 0;
};

/// Splits the maps so that no buffer of a page is larger than `max_bytes`; maps without photons at
/// either end of a page are left out. `map_count`: photons per sided triangle.
/// Errors: DeviceError when a single map alone is larger.
std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     std::uint64_t max_bytes);

}  // namespace photile::maps
