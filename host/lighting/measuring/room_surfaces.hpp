// Grids on the walls and the ceiling of a room, and on upright cylinders in it.
#pragma once

#include <vector>

#include "measuring/working_plane.hpp"

namespace photile::measuring {

/// A grid on each of four walls, at the sides of the upright rectangle around the room's plan, from
/// the floor to the ceiling, facing into the room; names say the direction in which the wall lies,
/// clockwise from straight ahead as seen from above. Points with no wall there, or glass, are
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
