// Points of a grid that furniture stands on.
#pragma once

#include <cstddef>

#include "measuring/sensor_grid.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

/// Makes those sensors of a grid blank, and takes the cells of a plane that are theirs:
/// - with a surface nearer than `clearance` metres, along or against their direction, on walls and
/// ceilings
///   along it; 0 = none;
/// - inside a solid, or beyond the walls that most of the grid stands within: of six rays, along
/// and across their direction, at least five cross an odd number
///   of surfaces where the same ray of most sensors of the grid crosses an even one, or the other
///   way round. Whichever way a closed mesh is wound, a ray from inside leaves it once more than it
///   enters it; a single sheet, such as a pane, turns no more than one or two of the rays.
/// Returns how many.
std::size_t leave_out_furniture(const Scene& scene, double clearance, SensorGrid& grid);

}  // namespace photile::measuring
