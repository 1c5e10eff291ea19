// Axis-parallel boxes.
#pragma once

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
};

using Box = BoxOf<float>;

/// Square of the distance between two boxes; infinite if one is empty.
inline float squared_distance(const Box& a, const Box& b) {
  const glm::vec3 gap = glm::max(glm::vec3(0.0f), glm::max(a.lower - b.upper, b.lower - a.upper));
  return glm::dot(gap, gap);
}

}  // namespace photile::geometry
