// Axis-parallel boxes.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace photile::geometry {

/// Empty until extended. Its corners are coordinates of the points themselves, so no rounding goes
/// into it.
template <class Scalar>
struct BoxOf {
  using Point = glm::vec<3, Scalar>;

  Point lower{std::numeric_limits<Scalar>::infinity()};
  Point upper{-std::numeric_limits<Scalar>::infinity()};

  void extend(const Point& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  void extend(const BoxOf& box) {
    lower = glm::min(lower, box.lower);
    upper = glm::max(upper, box.upper);
  }
  Point centre() const { return Scalar(0.5) * (lower + upper); }
  Point size() const { return upper - lower; }
  /// Half of the surface; 0 of an empty box.
  Scalar half_area() const {
    const Point side = glm::max(size(), Point(0));
    return side.x * side.y + side.y * side.z + side.z * side.x;
  }
  int longest_axis() const {
    const Point side = size();
    return side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  }
};

using Box = BoxOf<float>;

/// Square of the distance between two boxes; infinite if one is empty.
inline float squared_distance(const Box& a, const Box& b) {
  const auto squared_gap = [&](int axis) {
    const float gap = std::max(a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis]);
    return gap * std::max(0.0f, gap);  // a square that compilers turn into no branch
  };
  return squared_gap(0) + squared_gap(1) + squared_gap(2);
}

/// The most that squared_distance returns for boxes `radius` metres apart, with a margin for
/// rounding of a few parts in 10^7.
inline float squared_reach(double radius) {
  return static_cast<float>(radius * radius * (1 + 1e-5));
}

/// Whether they share a point. Without branches: most boxes are disjoint, along an unpredictable
/// axis.
inline bool overlap(const Box& a, const Box& b) {
  const auto overlap_along = [&](int axis) {
    return static_cast<int>(a.lower[axis] <= b.upper[axis]) &
           static_cast<int>(b.lower[axis] <= a.upper[axis]);
  };
  return (overlap_along(0) & overlap_along(1) & overlap_along(2)) != 0;
}

}  // namespace photile::geometry
