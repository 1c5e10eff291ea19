// Walls, furniture and luminaires around a grid of sensors, by which the reader of its plan knows
// the room.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
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

/// A lamp of the schedule.
struct LampMark {
  std::size_t number;  ///< from 1, that of the scene's light
  glm::dvec2 place;
  std::vector<glm::dvec2> outline;  ///< convex, of what shines; empty without a size
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

/// They as JSON has them: walls and furniture are paths of SVG, in metres along the plane's sides
/// from its corner.
///   north   degrees clockwise from -z as seen from above; none = not shown
nlohmann::ordered_json plan_json(const RayScene& rays, const measuring::PlaneLayout& layout,
                                 std::optional<double> north = std::nullopt);

}  // namespace photile::report
