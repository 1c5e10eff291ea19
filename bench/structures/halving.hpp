// How trees over photons halve them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace photile::structures {

struct PointBox {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};
};

/// The box of points[order[i]].
inline PointBox box_of(std::span<const glm::vec3> points, std::span<const std::uint32_t> order) {
  PointBox box;
  for (const std::uint32_t i : order) {
    box.low = glm::min(box.low, points[i]);
    box.high = glm::max(box.high, points[i]);
  }
  return box;
}

inline int widest_axis(const PointBox& box, int dimensions = 3) {
  int axis = 0;
  for (int d = 1; d < dimensions; ++d) {
    if (box.high[d] - box.low[d] > box.high[axis] - box.low[axis]) axis = d;
  }
  return axis;
}

/// Brings the `lower` points of least coordinate to the front; of equal ones, those of smaller
/// indices. So the two parts do not depend on the order before, and order[lower] is the least of
/// the upper part.
inline void split_at(std::span<const glm::vec3> points, std::span<std::uint32_t> order,
                     std::size_t lower, int axis) {
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(lower), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const float x = points[a][axis], y = points[b][axis];
                     return x < y || (x == y && a < b);
                   });
}

/// Parts of fewer points are built by one thread.
inline constexpr std::size_t least_parallel_points = 4096;

}  // namespace photile::structures
