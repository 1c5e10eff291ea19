#include "reading/polygon_triangulator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace photile::reading {
namespace {

bool comes_before(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Corner numbers from the lexicographically smallest corner on, towards its smaller neighbour.
/// `reversed` tells whether that runs against the polygon's own order.
std::vector<std::uint32_t> canonical_order(std::span<const glm::dvec3> corners, bool& reversed) {
  const auto count = static_cast<std::uint32_t>(corners.size());
  const auto first = static_cast<std::uint32_t>(
      std::min_element(corners.begin(), corners.end(), comes_before) - corners.begin());
  const std::uint32_t next = (first + 1) % count, previous = (first + count - 1) % count;
  reversed = comes_before(corners[previous], corners[next]);
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    order[i] = reversed ? (first + count - i) % count : (first + i) % count;
  }
  return order;
}

/// The polygon's points in a plane, counter-clockwise.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> corners,
                                const std::vector<std::uint32_t>& order) {
  glm::dvec3 normal(0.0);
  const glm::dvec3 origin = corners[order[0]];
  for (std::size_t i = 0; i < order.size(); ++i) {
    normal +=
        glm::cross(corners[order[i]] - origin, corners[order[(i + 1) % order.size()]] - origin);
  }
  const glm::dvec3 size = glm::abs(normal);
  const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  const double sign = normal[dropped] < 0.0 ? -1.0 : 1.0;
  std::vector<glm::dvec2> points;
  points.reserve(order.size());
  for (const std::uint32_t corner : order) {
    points.emplace_back(sign * (corners[corner][u] - origin[u]), corners[corner][v] - origin[v]);
  }
  return points;
}

/// Twice the signed area of a triangle.
double signed_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The part of a polygon that no ear has been cut from yet, as a ring of point numbers.
class Ring {
 public:
  explicit Ring(const std::vector<glm::dvec2>& points)
      : points_(points),
        next_(points.size()),
        previous_(points.size()),
        place_(points.size(), absent) {
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    for (std::uint32_t i = 0; i < count; ++i) update(i);
  }

  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }

  double corner_area(std::uint32_t i) const {
    return signed_area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  /// Whether the triangle at corner i lies inside the polygon.
  bool is_ear(std::uint32_t i) const {
    if (corner_area(i) <= 0.0) return false;
    const glm::dvec2 a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
    // Only a concave corner can poke into an ear. One that touches it at a corner does not.
    for (const std::uint32_t j : concave_) {
      if (points_[j] == a || points_[j] == b || points_[j] == c) continue;
      if (signed_area(a, b, points_[j]) >= 0.0 && signed_area(b, c, points_[j]) >= 0.0 &&
          signed_area(c, a, points_[j]) >= 0.0) {
        return false;
      }
    }
    return true;
  }

  void remove(std::uint32_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    set_concave(i, false);
    next_[before] = after;
    previous_[after] = before;
    update(before);
    update(after);
  }

 private:
  static constexpr std::uint32_t absent = 0xFFFF'FFFFu;

  void update(std::uint32_t i) { set_concave(i, corner_area(i) <= 0.0); }

  void set_concave(std::uint32_t i, bool concave) {
    if (concave == (place_[i] != absent)) return;
    if (concave) {
      place_[i] = static_cast<std::uint32_t>(concave_.size());
      concave_.push_back(i);
    } else {
      place_[concave_.back()] = place_[i];
      concave_[place_[i]] = concave_.back();
      concave_.pop_back();
      place_[i] = absent;
    }
  }

  const std::vector<glm::dvec2>& points_;
  std::vector<std::uint32_t> next_, previous_;
  std::vector<std::uint32_t> concave_;  ///< points with a concave corner, in no order
  std::vector<std::uint32_t> place_;    ///< of a point in concave_, or absent
};

}  // namespace

Triangulation triangulate_polygon(std::span<const glm::dvec3> corners) {
  Triangulation result;
  bool reversed = false;
  const std::vector<std::uint32_t> order = canonical_order(corners, reversed);
  const std::vector<glm::dvec2> points = project(corners, order);
  Ring ring(points);
  const auto emit = [&](std::uint32_t i) {
    std::array<std::uint32_t, 3> triangle{order[ring.previous(i)], order[i], order[ring.next(i)]};
    if (reversed) std::swap(triangle[0], triangle[2]);
    result.triangles.push_back(triangle);
  };
  std::uint32_t current = 0;
  std::size_t tried = 0;
  for (std::size_t left = points.size(); left > 3;) {
    // Corners on a straight line are no ears; they become ends of other ears. When a whole round
    // finds none, the polygon crosses itself or is flat, and any corner is as good as another.
    const bool stuck = tried == left;
    if (!stuck && !ring.is_ear(current)) {
      current = ring.next(current);
      ++tried;
      continue;
    }
    if (stuck && ring.corner_area(current) != 0.0) result.simple = false;
    emit(current);
    ring.remove(current);
    current = ring.next(current);
    tried = 0;
    --left;
  }
  if (points.size() > 3 && ring.corner_area(current) < 0.0) result.simple = false;
  emit(current);
  return result;
}

}  // namespace photile::reading
