// The grids of EN 12464-1 in a room: over its floor, on its walls and ceiling, and on upright
// cylinders.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// The room that grids are laid in, as planners describe it.
struct RoomSize {
  double area = 0;        ///< m2 of its plan, with what lies under slopes
  double height = 0;      ///< metres from its floor to most of its ceiling
  double floor = 0;       ///< height of its floor in the file's world
  glm::dvec2 sides{0.0};  ///< metres of the upright rectangle around its plan
  /// Of rooms_of: the camera's position, or a point in the room, in the file's world.
  glm::dvec3 inside{0.0};
};
/// Of the room around `inside`, or of the first camera's; none where the scene has no such room.
/// Errors: UsageError where the point is in none.
std::optional<RoomSize> room_size(const Scene& scene, const std::optional<glm::dvec3>& inside);
/// Those of the first 16 cameras, with the camera's index, and others with walls all around, with
/// `none`: each once, 100 at most.
std::vector<std::pair<std::uint32_t, RoomSize>> rooms_of(const Scene& scene);

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

/// Leaves out the points that are not in the room around a place in the file's world; all stay
/// where that is in none.
void keep_in_room(const Scene& scene, const glm::dvec3& place, SensorGrid& grid);

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

}  // namespace photile::measuring
