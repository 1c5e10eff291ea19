// The grids of EN 12464-1 in a room: over its floor, on its walls and ceiling, and on upright
// cylinders; and all that a command asks for.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "measuring/rooms.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

struct WorkingPlane {
  bool above_floor = true;  ///< whether `height` counts from the floor, or from the file's origin
  double height = 0;        ///< metres
  double wall_band = 0;     ///< metres that are left out along the floor's border
  double spacing = 0;       ///< metres; 0 = that of EN 12464-1
  double north = 0;         ///< degrees of north clockwise from straight ahead (-z), for names
  /// A point in the room, metres in the file's world; none = the first camera tells the room.
  std::optional<glm::dvec3> inside;
};

/// "floor+0.75", "floor", or "1.2": a height in the file's world. Errors: UsageError.
WorkingPlane parse_working_plane(const std::string& text);

/// Sensors that face up, in the middles of equal cells over the floor's bounding rectangle less the
/// wall band; cells whose middle is nearer to the floor's border than the band are left out.
///
/// The floor is that of the room around the given point, or of the one in which the first camera
/// stands or looks (see Room): the lowest level of horizontal surface, up to 2 cm thick, that has
/// at least half as much room above it as the widest level has, where room is 1.2 m to whatever is
/// above, which is less than 20 m up. Without such a room all levels of the scene count; where
/// nothing is covered, those under the open sky.
///
/// Errors: InputError naming the scene where there is no floor, or none left within the band;
/// UsageError where the given point is in no room.
SensorGrid working_plane_grid(const Scene& scene, const WorkingPlane& plane);

/// A grid on each of four walls, at the sides of the upright rectangle around the room's plan, from
/// the floor to the ceiling, facing into the room; names say by the compass where the wall lies:
/// "north wall". Points with no wall there, or glass, are
/// blank. Spacing as in working_plane_grid. Errors: InputError where the scene has no room with a
/// ceiling; UsageError where the given point is in none.
std::vector<SensorGrid> wall_grids(const Scene& scene, const WorkingPlane& plane);

/// A grid on the ceiling, facing down, at the height that most of it has; points elsewhere are
/// blank. Errors: as above.
SensorGrid ceiling_grid(const Scene& scene, const WorkingPlane& plane);

/// The grid over the floor, read by upright cylinders (EN 12464-1), or by upright half cylinders
/// that face four directions (semi-cylindrical: CIE, EN 13201-3): a grid for each. Errors: those of
/// working_plane_grid.
SensorGrid cylindrical_grid(const Scene& scene, const WorkingPlane& plane);
std::vector<SensorGrid> semi_cylindrical_grids(const Scene& scene, const WorkingPlane& plane);

/// Leaves out the points that are not in the room around a place in the file's world; all stay
/// where that is in none.
void keep_in_room(const Scene& scene, const glm::dvec3& place, SensorGrid& grid);

/// Where a command measures.
struct Places {
  std::vector<std::string> planes = {}, points = {};                ///< files
  std::string plane = {}, cylindrical = {}, semi_cylindrical = {};  ///< heights; "" = none
  bool walls = false, ceiling = false;
  WorkingPlane layout = {};           ///< of those in rooms, but their height
  std::vector<NamedRoom> rooms = {};  ///< each has these; empty = the one that `layout` tells
  double clearance = 0;               ///< metres from furniture

  bool empty() const;
};
/// The grids of these places, clear of furniture: those of files, then of each room; names of the
/// latter begin with the room's where there are rooms, and those that have no point of a grid are
/// told. The background of a task ends at the walls of its room. Errors: those of the readers, of
/// the above and of clear_of_furniture; UsageError where there are more than limits::max_sensors
/// points, or none.
std::vector<SensorGrid> grids_at(const Scene& scene, const Places& places, Progress& progress);

}  // namespace photile::measuring
