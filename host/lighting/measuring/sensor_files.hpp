// Sensors that a file describes: planes of them, or points.
#pragma once

#include <filesystem>
#include <vector>

#include "measuring/sensor_grid.hpp"

namespace photile::measuring {

/// Reads a JSON object {"name", "origin", "u", "v"} with either "spacing" or "columns" and "rows",
/// or a list of such: a rectangle from a corner along two sides at a right angle, metres in the
/// scene file's world, which faces u x v. Without a spacing it is that of EN 12464-1. With
/// "surroundings" the band of so many metres around it is a grid of its own. Errors: InputError
/// naming the file, the plane and the key.
std::vector<SensorGrid> read_planes(const std::filesystem::path& file);

/// Reads lines of six numbers: x y z of a point in metres and the direction that it faces, of any
/// length, separated by blanks, tabs or commas. Empty lines and those that start with # say
/// nothing. The grid bears the file's name without extension. Errors: InputError naming the file
/// and the line.
SensorGrid read_points(const std::filesystem::path& file);

}  // namespace photile::measuring
