#include "maps/map_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photile/errors.hpp"

namespace photile::maps {

std::uint32_t bytes_per_light(const SceneNeeds& needs) {
  if (!needs.several_lights()) return 0;
  return needs.light_count <= 256 ? 1 : 2;
}

std::uint32_t bytes_per_record(const SceneNeeds& needs) {
  constexpr std::uint32_t vector = 3 * sizeof(float);  // position, flux, direction
  return 2 * vector + sizeof(std::uint32_t) + bytes_per_light(needs) + (needs.glossy ? vector : 0);
}

void set_record_defines(device::Defines& defines, const SceneNeeds& needs) {
  if (const std::uint32_t bytes = bytes_per_light(needs); bytes > 0) {
    defines.set("LIGHT_BYTES", static_cast<long long>(bytes));
  }
  if (needs.glossy) defines.set("GLOSSY");
}

std::uint64_t PageLimits::most_records() const {
  const std::uint64_t floats = std::min<std::uint64_t>(largest_buffer / sizeof(float),
                                                       std::numeric_limits<std::uint32_t>::max());
  return std::max<std::uint64_t>(floats / 3, most_record_padding) - most_record_padding;
}

std::uint64_t PageLimits::bytes(std::uint64_t records, std::uint64_t maps) const {
  return records * bytes_per_record + maps * bytes_per_map;
}

bool PageLimits::fit(std::uint64_t records, std::uint64_t maps) const {
  return records <= most_records() && maps <= largest_buffer / sizeof(PhotileGrid) &&
         bytes(records, maps) <= page_bytes;
}

std::vector<MapRange> plan_map_pages(std::span<const std::uint32_t> map_count,
                                     const PageLimits& limits) {
  std::vector<MapRange> pages;
  for (std::uint32_t map = 0; map < map_count.size(); ++map) {
    const std::uint64_t records = map_count[map];
    if (records == 0) continue;
    if (pages.empty() ||
        !limits.fit(pages.back().records + records, map + 1 - pages.back().first)) {
      pages.push_back({map, map, 0});
    }
    pages.back().last = map + 1;
    pages.back().records += records;
  }
  return pages;
}

std::optional<std::pair<MapRange, MapRange>> halves_of(const MapRange& range,
                                                       std::span<const std::uint32_t> map_count) {
  MapRange first, second;
  for (std::uint32_t map = range.first; map < range.last; ++map) {
    const std::uint64_t records = map_count[map];
    if (records == 0) continue;
    // The first part takes maps up to the middle, one at least.
    const bool to_first = first.records == 0 || 2 * (first.records + records) <= range.records;
    MapRange& part = to_first && second.records == 0 ? first : second;
    if (part.records == 0) part.first = map;
    part.last = map + 1;
    part.records += records;
  }
  if (second.records == 0) return std::nullopt;
  return std::pair(first, second);
}

PageQueue::PageQueue(std::span<const std::uint32_t> map_count, const PageLimits& limits,
                     NameMap name_map)
    : map_count_(map_count), limits_(limits), name_map_(std::move(name_map)) {
  for (const MapRange& page : plan_map_pages(map_count, limits)) pages_.push_back(page);
}

std::optional<MapRange> PageQueue::next() {
  if (pages_.empty()) return std::nullopt;
  const MapRange page = pages_.front();
  pages_.pop_front();
  const std::uint64_t most = limits_.most_records();
  if (page.records > most) {
    throw DeviceMemoryError(fmt::format(
        "the photon map of {} has {} photons, more than the {} that the device's largest buffer "
        "holds; use fewer photons, more passes, or a larger memory limit if one is set",
        name_map_(page.first), page.records, most));
  }
  return page;
}

bool PageQueue::cut(const MapRange& page) {
  const auto halves = halves_of(page, map_count_);
  if (!halves) return false;
  pages_.push_front(halves->second);
  pages_.push_front(halves->first);
  return true;
}

std::uint64_t PageQueue::bytes(const MapRange& page) const {
  return limits_.bytes(page.records, page.last - page.first);
}

}  // namespace photile::maps
