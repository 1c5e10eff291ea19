// Grids of points, as the module passes them between its parts.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "parts.hpp"
#include "photile/sensors.hpp"

namespace photile::python {

using SharedGrid = std::shared_ptr<measuring::SensorGrid>;

/// A list of grids. Errors: UsageError where an item is none.
std::vector<measuring::SensorGrid> grids_of(const pybind11::list& grids);

/// A copy of the scene with the windows of the rooms that grids are in.
///   asked   as SceneLoadOptions::portals
SharedScene with_portals(const SharedScene& scene, const std::vector<measuring::SensorGrid>& grids,
                         const std::vector<std::string>& asked);

/// A copy of the scene without the lights from beyond it that it has last: its sun, sky and ground.
SharedScene without_sky(const SharedScene& scene);

/// Refuses numbers that the command's options refuse. Errors: UsageError.
void check_measuring(const MeasuringParameters& parameters);

/// JSON as Python's own objects.
pybind11::object parsed(const std::string& json);

}  // namespace photile::python
