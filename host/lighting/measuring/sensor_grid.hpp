// Sensors that are read together: those of a plane, or of a file of points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "photile/sensors.hpp"

namespace photile::measuring {

/// A rectangle of equal cells. Cell c is in column c % columns, counted along `u`, and in row
/// c / columns, along `v`.
struct PlaneLayout {
  glm::dvec3 origin{0.0};  ///< its corner, in the scene file's world, metres
  glm::dvec3 u{0.0};       ///< its whole sides, at a right angle; it faces u x v
  glm::dvec3 v{0.0};
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> cells;  ///< of each sensor, ascending: some cells may have none

  glm::dvec3 normal() const { return glm::normalize(glm::cross(u, v)); }
  /// A place on the plane, counted in cells from the corner, and where a point lies over it.
  glm::dvec3 at(const glm::dvec2& in_cells) const;
  glm::dvec2 in_cells(const glm::dvec3& point) const;
  glm::dvec3 middle_of(std::uint32_t cell) const;
  double spacing() const { return glm::length(u) / columns; }  ///< metres, along u
};

/// A plane of the scene's own coordinates in the file's world, and back.
PlaneLayout in_world(const Scene& scene, PlaneLayout layout);
PlaneLayout in_scene(const Scene& scene, PlaneLayout layout);

/// A point of a grid that is not measured.
struct BlankPoint {
  Sensor sensor;
  std::string reason;      ///< "inside a solid or beyond the walls"
  std::size_t before = 0;  ///< number of sensors that stand before it in the grid
};

/// The role of a grid, for the requirements of standards.
enum class GridRole { task, surroundings, background, wall, ceiling, cylindrical, other };

struct SensorGrid {
  std::string name;
  std::vector<Sensor> sensors;          ///< in the scene file's world
  std::optional<PlaneLayout> layout;    ///< of a plane
  std::vector<BlankPoint> blanks = {};  ///< in the order of the grid
  GridRole role = GridRole::task;
  std::string target = {};  ///< its requirement, as parse_requirement reads it; "" = none
  std::string remark = {};  ///< what the user should know of its position; "" = nothing
  bool chosen = false;      ///< by the program, which leaves out points that are in the way
  /// Of those a point in their room, in the scene file's world; none = the first camera tells it.
  std::optional<glm::dvec3> inside = std::nullopt;
  /// Of each sensor why its value is doubtful, "" = it is not; empty = none is.
  std::vector<std::string> marks = {};
};

/// Numbers of points by what is said of them, in the order of the first of each.
using CountedReasons = std::vector<std::pair<std::string, std::size_t>>;
/// Of the grid's blank points, and of its marks.
CountedReasons counted_blanks(const SensorGrid& grid);
CountedReasons counted_marks(const SensorGrid& grid);

/// Sensors in the middles of the layout's cells.
SensorGrid grid_on_plane(const std::string& name, PlaneLayout layout);

/// Number of equal cells along the sides of a calculation area, as EN 12464-1 (4.4) has it: spacing
/// p = 0.2 x 5^log10(d), at most 10 m, where d is the longer side, or the shorter one where the
/// longer is twice as long or more. Along d there are d / p points, rounded to a whole number; the
/// spacing that results sets the number along the other side.
///   u, v   metres, > 0
struct PointCounts {
  int columns = 1;  ///< along u
  int rows = 1;     ///< along v
  std::uint64_t total() const {
    return static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  }
};
PointCounts points_of_en12464(double u, double v);
/// As many as a spacing makes, metres; 0 = that of EN 12464-1.
PointCounts points_at(double u, double v, double spacing);

/// A rectangle with a sensor in each of its cells.
PlaneLayout full_plane(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v,
                       const PointCounts& counts);

/// Reads a JSON object {"name", "origin", "u", "v"} with either "spacing" or "columns" and "rows",
/// or a list of such: a rectangle from a corner along two sides at a right angle, metres in the
/// scene file's world, which faces u x v. Without a spacing it is that of EN 12464-1. Of a plane
/// with an "outline" [[x, y], ...], metres along u and v, only points within it are kept. With
/// "surroundings" the band of this many metres around it is a separate grid, and with "background"
/// the band around that; a task comes first, and all have its "target". Errors: InputError naming
/// file, plane and key.
std::vector<SensorGrid> read_planes(const std::filesystem::path& file);

/// Reads lines of six numbers: x y z of a point in metres and the direction that it faces, of any
/// length, separated by blanks, tabs or commas. Empty lines and those that start with # say
/// nothing. The grid bears the file's name without extension. Errors: InputError naming the file
/// and the line.
SensorGrid read_points(const std::filesystem::path& file);

}  // namespace photile::measuring
