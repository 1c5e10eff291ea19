// A measurement as text: CSV, JSON, and lines to read.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measuring/measurement.hpp"

namespace photile::report {

/// A line for each sensor, with a heading: grid, point (from 0), x, y, z, dx, dy, dz, lux,
/// standard_error; with several lights also `lux <light>` and `standard_error <light>` of each.
std::string measurement_csv(const measuring::Measurement& measurement,
                            const std::string& unit = "lux");

/// Array of grids, each with `name`, `points`, `plane` (where it is one), `statistics` and
/// `sensors`.
nlohmann::ordered_json measurement_json(const measuring::Measurement& measurement);

/// A line for each grid and light, with a heading: Em, Emin, Emax, Uo, Ud with standard errors.
std::vector<std::string> measurement_lines(const measuring::Measurement& measurement,
                                           const std::string& unit = "lux");

}  // namespace photile::report
