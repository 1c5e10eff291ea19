// Sensor points as Radiance's rtrace and Honeybee read them.
#pragma once

#include <filesystem>

#include "measuring/sensor_grid.hpp"

namespace photile::measuring {

/// Reads lines of six numbers: x y z of a point in metres and the direction that it faces, of any
/// length, separated by blanks, tabs or commas. Empty lines and those that start with # say
/// nothing. The grid bears the file's name without extension. Errors: InputError naming the file
/// and the line.
SensorGrid read_points(const std::filesystem::path& file);

}  // namespace photile::measuring
