// Distances between points, segments and triangles, in double precision.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "photile/scene.hpp"

namespace photile::geometry {

using TriangleCorners = std::array<glm::dvec3, 3>;

inline TriangleCorners corners_of(const Scene& scene, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  return {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
}

/// Square of the distance from `point` to `triangle`, in square metres. A triangle without area
/// counts as its edges.
double squared_point_triangle_distance(const glm::dvec3& point, const TriangleCorners& triangle);

}  // namespace photile::geometry
