#include "estimate/map_order.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "geometry/box.hpp"
#include "geometry/radix_sort.hpp"
#include "trace/hit_batch.hpp"

namespace photile::estimate {
namespace {

/// values[order[i]] for each i.
template <class T>
std::vector<T> gather(const std::vector<T>& values, std::span<const std::uint32_t> order) {
  if (values.empty()) return {};
  std::vector<T> result(order.size());
  tbb::parallel_for(std::size_t{0}, order.size(),
                    [&](std::size_t i) { result[i] = values[order[i]]; });
  return result;
}

}  // namespace

std::vector<std::uint32_t> order_by_map(std::span<const std::uint32_t> maps,
                                        std::span<const glm::vec3> position) {
  if (std::is_sorted(maps.begin(), maps.end())) return {};
  geometry::Box box;
  for (const glm::vec3& one : position) box.extend(one);
  const trace::HitCells cells(box);
  struct Key {
    std::uint64_t order;
    std::uint32_t hit;
  };
  constexpr int code_bits = 3 * trace::HitCells::bits_per_axis;
  std::vector<Key> keys(maps.size());
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
    // `none`, the map of hits that have no other, loses its upper bit and stays the last.
    keys[i] = {std::uint64_t{maps[i]} << code_bits | cells.morton_code(position[i]),
               static_cast<std::uint32_t>(i)};
  });
  geometry::radix_sort(keys, 64, [](const Key& key) { return key.order; });
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.hit);
  return order;
}

PrimaryHits reordered(const PrimaryHits& hits, std::span<const std::uint32_t> order) {
  PrimaryHits result;
  result.position = gather(hits.position, order);
  result.oriented_face = gather(hits.oriented_face, order);
  result.diffuse_albedo = gather(hits.diffuse_albedo, order);
  result.outgoing = gather(hits.outgoing, order);
  result.lobe = gather(hits.lobe, order);
  return result;
}

}  // namespace photile::estimate
