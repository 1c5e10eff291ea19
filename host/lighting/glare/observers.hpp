// Where glare is rated: places of eyes and directions of view.
#pragma once

#include <vector>

#include "glare/position_index.hpp"
#include "measuring/sensor_grid.hpp"
#include "trace/room.hpp"

namespace photile::glare {

/// An observer at each point, who looks where it faces. Names are the grid's with the number of the
/// point, from 1.
std::vector<Observer> observers_at(const measuring::SensorGrid& points,
                                   const measuring::PlanAxes& axes);

/// At each point of a level plane one who looks in each of several directions, which are spread
/// evenly round the level and begin with `ahead`: the four of EN 12464-1 are along the walls of a
/// room that stands along the axes. Names say "plane 3, 90 degrees", clockwise as seen from above.
std::vector<Observer> observers_on(const measuring::SensorGrid& plane,
                                   const measuring::PlanAxes& axes, int directions);

}  // namespace photile::glare
