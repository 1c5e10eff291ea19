#include "estimate/map_order.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

namespace photile::estimate {
namespace {

/// values[first + order[i]] for each i.
template <class T>
std::vector<T> gather(const std::vector<T>& values, std::span<const std::uint32_t> order,
                      std::size_t first = 0) {
  if (values.empty()) return {};
  std::vector<T> result(order.size());
  tbb::parallel_for(std::size_t{0}, order.size(),
                    [&](std::size_t i) { result[i] = values[first + order[i]]; });
  return result;
}

}  // namespace

std::vector<std::uint32_t> order_by_map(std::span<const std::uint32_t> maps) {
  if (std::is_sorted(maps.begin(), maps.end())) return {};
  // All cores sort: a GPU waits for it. No two keys are equal, which makes it stable.
  std::vector<std::uint64_t> keys(maps.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = std::uint64_t{maps[i]} << 32 | i;
  tbb::parallel_sort(keys);
  std::vector<std::uint32_t> order(maps.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
  return order;
}

Estimates restored(Estimates estimates, std::span<const std::uint32_t> order,
                   std::size_t light_count) {
  if (estimates.first.empty()) {
    restore_rows(estimates.irradiance, order, light_count);
    restore_rows(estimates.radiance, order, light_count);
    return estimates;
  }
  std::vector<std::uint32_t> position_of(order.size());  // of each hit among the reordered
  for (std::uint32_t i = 0; i < order.size(); ++i) position_of[order[i]] = i;
  std::vector<std::uint32_t> slots;
  std::vector<std::uint64_t> first{0};
  for (const std::uint32_t i : position_of) {
    for (std::uint64_t slot = estimates.first[i]; slot < estimates.first[i + 1]; ++slot) {
      slots.push_back(static_cast<std::uint32_t>(slot));
    }
    first.push_back(slots.size());
  }
  Estimates result;
  result.irradiance = gather(estimates.irradiance, slots);
  result.radiance = gather(estimates.radiance, slots);
  result.light = gather(estimates.light, slots);
  result.first = std::move(first);
  return result;
}

PrimaryHits reordered(const PrimaryHits& hits, std::size_t first,
                      std::span<const std::uint32_t> order) {
  PrimaryHits result;
  result.position = gather(hits.position, order, first);
  result.oriented_face = gather(hits.oriented_face, order, first);
  result.diffuse_albedo = gather(hits.diffuse_albedo, order, first);
  result.outgoing = gather(hits.outgoing, order, first);
  result.lobe = gather(hits.lobe, order, first);
  return result;
}

}  // namespace photile::estimate

namespace photile {

void Estimates::append(Estimates part) {
  if (irradiance.empty() && first.size() <= 1) {
    *this = std::move(part);
    return;
  }
  const std::uint64_t before = irradiance.size();
  irradiance.insert(irradiance.end(), part.irradiance.begin(), part.irradiance.end());
  radiance.insert(radiance.end(), part.radiance.begin(), part.radiance.end());
  by_normal.insert(by_normal.end(), part.by_normal.begin(), part.by_normal.end());
  light.insert(light.end(), part.light.begin(), part.light.end());
  for (std::size_t hit = 1; hit < part.first.size(); ++hit) {
    first.push_back(before + part.first[hit]);
  }
}

}  // namespace photile
