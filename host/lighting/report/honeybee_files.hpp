// Results in the files that Honeybee and Ladybug Tools read.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "measuring/measurement.hpp"

namespace photile::report {

/// The files that are written whatever the grids are.
inline constexpr std::array honeybee_tables{"grids_info.json", "grid_summary.csv"};

/// The file of each grid, `<grid>.res`: characters that a file's name should not have become `_`.
/// Errors: UsageError where two grids would share a name.
std::vector<std::string> honeybee_names(const std::vector<measuring::SensorGrid>& grids);

/// Name -> content: `<grid>.res` with the lux of a sensor on each line, `grids_info.json` with the
/// grids' `name`, `identifier`, `full_id`, `group` and `count`, and `grid_summary.csv` as
/// honeybee-radiance-postprocess writes it (uniformity in per cent).
/// Errors: UsageError where two grids would share a name.
std::map<std::string, std::string> honeybee_files(const measuring::Measurement& measurement);

}  // namespace photile::report
