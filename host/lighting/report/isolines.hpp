// Lines of equal value over a grid.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photile::report {

using Segment = std::array<glm::dvec2, 2>;

/// Segments along which values between the middles of cells are `level`, by linear interpolation
/// along the lines that join them (marching squares; Lorensen and Cline, "Marching cubes", 1987).
/// Where both diagonals may be joined, the mean of the four decides. Squares with a NaN have none.
///   values   columns x rows, row by row
///   returns  places in cells: (0.5, 0.5) is the middle of the first
std::vector<Segment> isoline(std::span<const double> values, int columns, int rows, double level);

/// Convex polygons that together cover where values lie between two levels. Each square of middles
/// is four triangles around its middle, whose value is the mean, with linear interpolation in each.
/// Arguments and places as above.
using Polygon = std::vector<glm::dvec2>;
std::vector<Polygon> isoband(std::span<const double> values, int columns, int rows, double low,
                             double high);

}  // namespace photile::report
