// Splits a polygon into triangles by ear clipping.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photile::reading {

struct Triangulation {
  /// Corner numbers, three for each triangle, wound as the polygon is.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// False when the polygon crosses itself or has no area: the triangles then cover it as well as
  /// they can.
  bool simple = true;
};

/// Triangulates a polygon of at least 3 corners that may be concave and slightly bent. Works in
/// the plane of the polygon's mean normal (Newell's), in double precision. The triangles and their
/// order do not depend on the polygon's winding nor on the corner it starts from. Quadratic in the
/// number of concave corners.
Triangulation triangulate_polygon(std::span<const glm::dvec3> corners);

}  // namespace photile::reading
