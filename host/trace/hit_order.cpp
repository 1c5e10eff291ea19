#include "trace/hit_order.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

namespace photile::trace {

namespace {

constexpr std::uint64_t cells_per_axis = 1ull << 21;

/// Puts two zero bits between the 21 lowest bits.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001F00000000FFFFull;
  x = (x | x << 16) & 0x001F0000FF0000FFull;
  x = (x | x << 8) & 0x100F00F00F00F00Full;
  x = (x | x << 4) & 0x10C30C30C30C30C3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

std::uint64_t cell(double position, double low, double high) {
  const double part = high > low ? std::clamp((position - low) / (high - low), 0.0, 1.0) : 0.0;
  return std::min(static_cast<std::uint64_t>(part * cells_per_axis), cells_per_axis - 1);
}

struct Key {
  std::uint32_t map;
  std::uint32_t number;  ///< of the hit, counted through all records
  std::uint64_t code;
  bool operator<(const Key& other) const {
    return std::tie(map, code, number) < std::tie(other.map, other.code, other.number);
  }
};

}  // namespace

std::uint64_t morton_code(const glm::vec3& position, const Box& box) {
  return spread(cell(position.x, box.low.x, box.high.x)) |
         spread(cell(position.y, box.low.y, box.high.y)) << 1 |
         spread(cell(position.z, box.low.z, box.high.z)) << 2;
}

std::vector<HitPlace> sorted_places(std::span<const EyeRecord> records, const Box& box,
                                    std::span<const std::uint32_t> map_of) {
  std::vector<std::uint32_t> first{0};
  for (const EyeRecord& record : records) {
    first.push_back(first.back() + static_cast<std::uint32_t>(record.hits.size()));
  }
  std::vector<Key> keys(first.back());
  std::vector<std::uint32_t> record_of(first.back());
  tbb::parallel_for(std::size_t{0}, records.size(), [&](std::size_t record) {
    std::uint32_t number = first[record];
    for (const EyeHit& hit : records[record].hits) {
      const std::uint32_t own = hit.sided_triangle;
      keys[number] = {map_of.empty() ? own : map_of[own], number, morton_code(hit.position, box)};
      record_of[number++] = static_cast<std::uint32_t>(record);
    }
  });
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<HitPlace> places(keys.size());
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
    const std::uint32_t record = record_of[keys[i].number];
    places[i] = {record, keys[i].number - first[record]};
  });
  return places;
}

}  // namespace photile::trace
