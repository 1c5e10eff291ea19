#include "groups/proximity_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/triangle_distance.hpp"
#include "groups/group_lists.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::groups {
namespace {

using geometry::TriangleCorners;

TriangleCorners corners_of(const Scene& scene, std::uint32_t triangle) {
  const auto corners = scene.corners(triangle);
  return {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
}

/// Centre of the smallest ball that holds the triangle. It lies in the triangle: the middle of the
/// longest edge of an obtuse one, the circumcentre of an acute one.
glm::dvec3 smallest_ball_centre(const TriangleCorners& corners) {
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &apex = corners[i], &p = corners[(i + 1) % 3], &q = corners[(i + 2) % 3];
    if (glm::dot(p - apex, q - apex) <= 0) return 0.5 * (p + q);
  }
  const glm::dvec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  const glm::dvec3 normal = glm::cross(u, v);
  return corners[0] + glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) /
                          (2.0 * glm::dot(normal, normal));
}

bool share_a_vertex(const glm::uvec3& a, const glm::uvec3& b) {
  for (int i = 0; i < 3; ++i) {
    if (a[i] == b.x || a[i] == b.y || a[i] == b.z) return true;
  }
  return false;
}

/// Lower bound of the distance: how far b begins behind the end of a along `direction`, metres.
double gap_along(const glm::dvec3& direction, const TriangleCorners& a, const TriangleCorners& b) {
  double end_of_a = glm::dot(direction, a[0]), start_of_b = glm::dot(direction, b[0]);
  for (int i = 1; i < 3; ++i) {
    end_of_a = std::max(end_of_a, glm::dot(direction, a[i]));
    start_of_b = std::min(start_of_b, glm::dot(direction, b[i]));
  }
  const double length = glm::length(direction);
  return length > 0 ? (start_of_b - end_of_a) / length : 0.0;
}

/// Upper bound of the squared distance: that of the nearest two corners.
double squared_corner_distance(const TriangleCorners& a, const TriangleCorners& b) {
  double squared = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& p : a) {
    for (const glm::dvec3& q : b) squared = std::min(squared, glm::dot(p - q, p - q));
  }
  return squared;
}

/// Bound on the rounding of distances in this scene, metres: coordinates times some hundred units
/// of double precision.
double rounding_margin(const Scene& scene, double radius) {
  double largest = radius;
  for (const glm::vec3& vertex : scene.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max(largest, static_cast<double>(std::abs(vertex[axis])));
    }
  }
  return 1e-12 * largest;
}

}  // namespace

ProximityTest::ProximityTest(const Scene& scene, double radius) : scene_(scene), radius_(radius) {
  const double margin = rounding_margin(scene, radius);
  outer_ = radius + margin;
  squared_inner_ = radius > margin ? (radius - margin) * (radius - margin) : -1.0;
}

TriangleBound ProximityTest::bound(std::uint32_t triangle) const {
  const TriangleCorners corners = corners_of(scene_, triangle);
  TriangleBound bound{};
  bound.triangle = triangle;
  bound.normal = sided_normal(scene_, sided(triangle, 0));
  bound.centre = smallest_ball_centre(corners);
  for (const glm::dvec3& corner : corners) {
    bound.radius = std::max(bound.radius, glm::distance(bound.centre, corner));
  }
  return bound;
}

bool ProximityTest::within_by_corners(const TriangleBound& a, const TriangleBound& b) const {
  if (share_a_vertex(scene_.triangles[a.triangle], scene_.triangles[b.triangle])) return true;
  const TriangleCorners corners_a = corners_of(scene_, a.triangle);
  const TriangleCorners corners_b = corners_of(scene_, b.triangle);
  if (gap_along(b.centre - a.centre, corners_a, corners_b) > outer_) return false;
  if (squared_corner_distance(corners_a, corners_b) <= squared_inner_) return true;
  // The ball of the smaller triangle against the larger triangle itself: settles small triangles
  // beside a wall, whose own ball is as large as the room.
  const bool a_is_smaller = a.radius < b.radius;
  const TriangleBound& small = a_is_smaller ? a : b;
  const double squared =
      geometry::squared_point_triangle_distance(small.centre, a_is_smaller ? corners_b : corners_a);
  if (squared <= squared_inner_) return true;
  const double farthest = outer_ + small.radius;
  if (squared > farthest * farthest) return false;
  return triangle_triangle_distance(corners_a, corners_b) <= radius_;
}

}  // namespace photile::groups

namespace photile {

bool normals_agree(const glm::dvec3& a, const glm::dvec3& b, double cos_angle) {
  return (groups::agreeing_sides(a, b, cos_angle) & groups::equal_sides) != 0;
}

}  // namespace photile
