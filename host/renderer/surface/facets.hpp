// Facets: connected triangles in one plane, and the edges that bound them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "surface/surface_mesh.hpp"

namespace photile::surface {

struct BorderEdge {
  glm::vec3 from, to;
  glm::vec3 inward;  ///< unit, in the plane of the triangle, perpendicular to the edge
  std::uint32_t triangle;
};

struct Facets {
  /// Per triangle: its facet where hits look at the facet's border, PHOTILE_NO_FACET where they
  /// look at the triangles, because those are few.
  std::vector<std::uint32_t> of_triangle;
  /// Per triangle: a number that the triangles of its facet share, bordered or not.
  std::vector<std::uint32_t> plane;
  std::vector<BorderEdge> borders;  ///< of the facets in `of_triangle`
};

/// Grows facets from the largest triangles on. Normals within a facet differ by less than the slack
/// of normals_agree, heights by less than a thousandth of the radius.
///   dark   per sided triangle: no facet goes on where that of one of its sides changes; or empty
Facets find_facets(const SurfaceMesh& mesh, double radius, std::span<const std::uint8_t> dark = {});

}  // namespace photile::surface
