// The options of how sensors are read, which measure, daylight and glare share.
#pragma once

#include <string>

#include "measuring/measure_grids.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds --rays and --repeats.
void add_sensor_options(CLI::App& command, MeasuringParameters& parameters,
                        const std::string& group);

/// Adds --maintenance.
void add_maintenance_option(CLI::App& command, MeasuringParameters& parameters,
                            const std::string& group);

}  // namespace photile::app
