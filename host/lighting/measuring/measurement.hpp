// A finished measurement: grids with the values of their sensors and what follows from them.
#pragma once

#include <string>
#include <vector>

#include "measuring/grid_statistics.hpp"
#include "measuring/readings.hpp"
#include "measuring/sensor_grid.hpp"

namespace photile::measuring {

/// Values of one light, or of all together, at the sensors of a grid.
struct LightValues {
  std::string light;  ///< "" for all together
  std::vector<Measured> sensors;
  GridStatistics statistics;
};

struct GridValues {
  SensorGrid grid;
  std::vector<LightValues> lights;  ///< all together first; with one light, nothing else

  const LightValues& total() const { return lights.front(); }
};

using Measurement = std::vector<GridValues>;  ///< lux

/// The values of each grid. `readings` are those of all grids' sensors, one grid after the other.
Measurement measurement_of(std::vector<SensorGrid> grids, const Readings& readings);

}  // namespace photile::measuring
