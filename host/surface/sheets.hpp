// Sheets: sided triangles that connect over edges which fold by no more than an angle.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/surface_mesh.hpp"

namespace photile::surface {

struct Sheets {
  std::vector<std::uint32_t> of;  ///< per sided triangle
  std::uint32_t count = 0;        ///< numbered in the order of their first sided triangles
};

/// Triangles connect where they share both corners of an edge, or where their edges run along each
/// other, however unlike their ends (as tiles do).
///   radius   metres: edges at most a thousandth of it apart run along each other
Sheets find_sheets(const SurfaceMesh& mesh, double radius, double angle_degrees);

}  // namespace photile::surface
