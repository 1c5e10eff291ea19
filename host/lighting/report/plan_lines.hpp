// Lines of a plan: of equal value over a grid of sensors, and walls, furniture and luminaires
// around them, by which a reader knows the room.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/ray_scene.hpp"

namespace photile::report {

using Segment = std::array<glm::dvec2, 2>;

/// Segments along which values between the middles of cells are `level`, by linear interpolation
/// along the lines that join them (marching squares; Lorensen and Cline, "Marching cubes", 1987).
/// Where both diagonals may be joined, the mean of the four decides. Squares with a NaN have none.
///   values   columns x rows, row by row
///   returns  positions in cells: (0.5, 0.5) is the middle of the first
std::vector<Segment> isoline(std::span<const double> values, int columns, int rows, double level);

/// Values between the middles of cells by bicubic interpolation (Catmull and Rom, 1974), so that
/// isolines are smooth: it keeps given values and follows linear ones exactly.
struct FineValues {
  std::vector<double> values;  ///< columns x rows, row by row; NaN beside a cell without a value
  int columns = 0, rows = 0;
  int per_cell = 1;  ///< steps from one middle to the next
  /// In cells, of a position among the values as isoline gives it.
  glm::dvec2 in_cells(const glm::dvec2& position) const {
    return (position - 0.5) / static_cast<double>(per_cell) + 0.5;
  }
};
FineValues refined(std::span<const double> values, int columns, int rows);

/// Convex polygons that together cover where values lie between two levels. Each square of middles
/// is four triangles around its middle, whose value is the mean, with linear interpolation in each.
/// Arguments and positions as above.
using Polygon = std::vector<glm::dvec2>;
std::vector<Polygon> isoband(std::span<const double> values, int columns, int rows, double low,
                             double high);

/// The values between two illuminances of the scale of EN 12464-1, whose steps are of about 1.5:
/// 5, 7.5, 10, 15, 20, 30, 50, 75, 100, ..., ascending. Lux, or whatever unit.
///   low, high   >= 0; nothing is below a thousandth of `high`
inline std::vector<double> illuminance_steps(double low, double high) {
  std::vector<double> steps;
  if (!(high > 0) || !std::isfinite(high)) return steps;
  const double least = std::max(low, high / 1000);
  for (double decade = std::pow(10, std::floor(std::log10(least))); decade < high; decade *= 10) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.5}) {
      if (step * decade > least && step * decade < high) steps.push_back(step * decade);
    }
  }
  return steps;
}

/// A lamp of the schedule.
struct LampMark {
  std::size_t number;  ///< from 1, that of the scene's light
  glm::dvec2 place;
};

/// Positions are counted in the plane's cells, from its corner, and may lie beyond its sides.
struct PlanSurroundings {
  double reach = 0;                ///< metres around the plane that are shown
  std::vector<Segment> walls;      ///< where the plane cuts surfaces
  std::vector<Segment> furniture;  ///< outlines of what stands below the plane
  std::vector<LampMark> lamps;     ///< lights with a position, above or below
  /// Two corners of the upright rectangle around the room, if the plane's middle is in one.
  std::optional<Segment> room = std::nullopt;
};

/// The middle of a lamp's surface, or where it is, in the scene's coordinates; nothing of the sky.
std::optional<glm::dvec3> place_of(const Scene& scene, const Light& light);

/// None but reach 0 for a plane that is not horizontal (y is up).
PlanSurroundings surroundings_of(const RayScene& rays, const measuring::PlaneLayout& layout);

}  // namespace photile::report
