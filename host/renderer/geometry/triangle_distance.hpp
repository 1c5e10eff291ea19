// Distances between points, segments and triangles, in double precision.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace photile::geometry {

using TriangleCorners = std::array<glm::dvec3, 3>;

/// Square of the distance from `point` to `triangle`, in square metres. A triangle without area
/// counts as its edges.
double squared_point_triangle_distance(const glm::dvec3& point, const TriangleCorners& triangle);

}  // namespace photile::geometry
