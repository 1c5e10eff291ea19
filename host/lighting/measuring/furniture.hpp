// Points of a grid that lie in things, on the faces of partitions, or close to furniture.
#pragma once

#include <cstddef>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

/// Makes those sensors of a grid blank, and takes the cells of a plane that are theirs:
/// - with a surface nearer than `clearance` metres, along or against their direction, on walls and
///   ceilings along it; 0 = none;
/// - inside a solid, or beyond the walls that most of the grid stands within: of six rays, along
///   and across their direction, at least five cross an odd number of surfaces where the same ray
///   of most sensors of the grid crosses an even one, or the other way round. Whichever way a
///   closed mesh is wound, a ray from inside leaves it once more than it enters it; a single sheet,
///   such as a pane, turns no more than one or two of the rays.
/// Where the program chose the points (SensorGrid::chosen), those become blank, too, and others get
/// a mark,
/// - that lie in a thing: in furniture that is hollow, open below or without a back, or in a closed
///   room within the room. The air of a room is what hangs below its ceiling: what is straight
///   below a point of the room's cut (trace::Room) with nothing between. A point is in a thing
///   where it is not in that air, where less than an eighth of the directions before it end in that
///   air or under the open sky, and where no row of points of the grid, each visible from the one
///   before through a gap of 10 cm, leads to it from that air. Where most of the grid seems to lie
///   in things, the room was misread, and no point counts as lying in one;
/// - with a surface less than a centimetre beside or before them, such as the face of a partition:
///   half of their light is hidden by what they touch.
/// Returns how many became blank.
std::size_t leave_out_furniture(const Scene& scene, double clearance, SensorGrid& grid);

/// The same of several grids, and tells how many points each loses and why.
///   may_lack   whether a grid of which nothing is left is only told, and goes
/// Errors: UsageError where nothing is left of a grid.
void clear_of_furniture(const Scene& scene, double clearance, bool may_lack,
                        std::vector<SensorGrid>& grids, Progress& progress);

}  // namespace photile::measuring
