// Planes of sensors, described in a file.
#pragma once

#include <filesystem>
#include <vector>

#include "measuring/sensor_grid.hpp"

namespace photile::measuring {

/// Reads a JSON object {"name", "origin", "u", "v"} with either "spacing" or "columns" and "rows",
/// or a list of such: a rectangle from a corner along two sides at a right angle, metres in the
/// scene file's world, which faces u x v. Without a spacing it is that of EN 12464-1. Errors:
/// InputError naming the file, the plane and the key.
std::vector<SensorGrid> read_planes(const std::filesystem::path& file);

}  // namespace photile::measuring
