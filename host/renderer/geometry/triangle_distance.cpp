// The distance between two triangles is reached in one of three ways (Eberly, "Distance Between Two
// Triangles in 3D"): they intersect; a corner of one is nearest to the other; or two edges are
// nearest to each other inside both. Trying all of them, 6 + 6 + 9, needs no case analysis, so
// needles and triangles without area need no special path: every candidate is the distance of two
// real points up to rounding, and one of them is the nearest pair.
#include "geometry/triangle_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "photile/neighbour_groups.hpp"

namespace photile {
namespace geometry {
namespace {

double squared_length(const glm::dvec3& v) { return glm::dot(v, v); }

double squared_point_segment_distance(const glm::dvec3& point, const glm::dvec3& from,
                                      const glm::dvec3& to) {
  const glm::dvec3 edge = to - from;
  const glm::dvec3 offset = point - from;
  const double squared = squared_length(edge);
  const double t = squared > 0 ? std::clamp(glm::dot(offset, edge) / squared, 0.0, 1.0) : 0.0;
  return std::min(
      {squared_length(offset - t * edge), squared_length(offset), squared_length(point - to)});
}

/// Distance of two segments where both nearest points are inside them, else infinity. Written with
/// the cross product: the error grows with 1 / sine of the angle between nearly parallel segments,
/// not with its square.
double squared_inner_segment_distance(const glm::dvec3& p0, const glm::dvec3& p1,
                                      const glm::dvec3& q0, const glm::dvec3& q1) {
  const glm::dvec3 u = p1 - p0, v = q1 - q0, r = q0 - p0;
  const glm::dvec3 normal = glm::cross(u, v);
  const double squared = squared_length(normal);
  const double s = glm::dot(glm::cross(r, v), normal);
  const double t = glm::dot(glm::cross(r, u), normal);
  if (!(s > 0 && s < squared && t > 0 && t < squared)) {
    return std::numeric_limits<double>::infinity();
  }
  return squared_length(r + (t / squared) * v - (s / squared) * u);
}

/// Whether the segment crosses the triangle's plane inside the triangle. Touching need not count:
/// then some corner or pair of edges is at distance 0.
bool pierces(const glm::dvec3& from, const glm::dvec3& to, const TriangleCorners& triangle,
             const glm::dvec3& normal) {
  const double height_from = glm::dot(normal, from - triangle[0]);
  const double height_to = glm::dot(normal, to - triangle[0]);
  if (!((height_from > 0 && height_to < 0) || (height_from < 0 && height_to > 0))) return false;
  const glm::dvec3 direction = to - from;
  const glm::dvec3 a = triangle[0] - from, b = triangle[1] - from, c = triangle[2] - from;
  const double ab = glm::dot(direction, glm::cross(a, b));
  const double bc = glm::dot(direction, glm::cross(b, c));
  const double ca = glm::dot(direction, glm::cross(c, a));
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

}  // namespace

double squared_point_triangle_distance(const glm::dvec3& point, const TriangleCorners& triangle) {
  const glm::dvec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double squared = squared_length(normal);
  bool inside = squared > 0;
  for (int i = 0; i < 3 && inside; ++i) {
    const glm::dvec3 edge = triangle[(i + 1) % 3] - triangle[i];
    inside = glm::dot(glm::cross(normal, edge), point - triangle[i]) >= 0;
  }
  if (inside) {
    const double height = glm::dot(normal, point - triangle[0]);
    return height * height / squared;
  }
  return std::min({squared_point_segment_distance(point, triangle[0], triangle[1]),
                   squared_point_segment_distance(point, triangle[1], triangle[2]),
                   squared_point_segment_distance(point, triangle[2], triangle[0])});
}

}  // namespace geometry

double triangle_triangle_distance(const std::array<glm::dvec3, 3>& a,
                                  const std::array<glm::dvec3, 3>& b) {
  const glm::dvec3 normal_a = glm::cross(a[1] - a[0], a[2] - a[0]);
  const glm::dvec3 normal_b = glm::cross(b[1] - b[0], b[2] - b[0]);
  double squared = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &a0 = a[i], &a1 = a[(i + 1) % 3];
    const glm::dvec3 &b0 = b[i], &b1 = b[(i + 1) % 3];
    if (geometry::pierces(a0, a1, b, normal_b) || geometry::pierces(b0, b1, a, normal_a)) return 0;
    squared = std::min({squared, geometry::squared_point_triangle_distance(a0, b),
                        geometry::squared_point_triangle_distance(b0, a)});
    for (int j = 0; j < 3; ++j) {
      squared =
          std::min(squared, geometry::squared_inner_segment_distance(a0, a1, b[j], b[(j + 1) % 3]));
    }
  }
  return std::sqrt(squared);
}

}  // namespace photile
