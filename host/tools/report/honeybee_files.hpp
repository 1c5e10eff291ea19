// Results in the files that Honeybee and Ladybug Tools read.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "measuring/measurement.hpp"

namespace photile::measuring {

/// Name -> content: `<grid>.res` with the lux of a sensor on each line, `grids_info.json` with the
/// grids' `name`, `identifier`, `full_id`, `group` and `count`, and `grid_summary.csv` as
/// honeybee-radiance-postprocess writes it (uniformity in per cent). Characters that a file's name
/// should not have become `_`. Errors: UsageError where two grids would share a name.
std::map<std::string, std::string> honeybee_files(const Measurement& measurement);

}  // namespace photile::measuring
