// Hits in the order of the maps they lie on.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/ray_scene.hpp"

namespace photile::estimate {

/// Numbers of hits in ascending order of their maps, and on each map along a Morton curve: kernels
/// find what is near one hit near the next. Empty where they are in the order of their maps
/// already.
///   maps, position   of the hits
std::vector<std::uint32_t> order_by_map(std::span<const std::uint32_t> maps,
                                        std::span<const glm::vec3> position);

/// Hit i of the result is hit first + order[i]. Pixels and throughput, which no estimate reads, are
/// left out.
PrimaryHits reordered(const PrimaryHits& hits, std::size_t first,
                      std::span<const std::uint32_t> order);

/// The light at reordered hits, put back: row i becomes row order[i].
LightTable restored(const LightTable& light, std::span<const std::uint32_t> order);

/// Puts rows of `width` values back: row i of `values` becomes row order[i].
template <class T>
void restore_rows(std::vector<T>& values, std::span<const std::uint32_t> order, std::size_t width) {
  if (values.empty()) return;
  std::vector<T> restored(values.size());
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
    std::copy_n(&values[i * width], width, &restored[order[i] * width]);
  });
  values = std::move(restored);
}

}  // namespace photile::estimate
