// What photile.report writes Honeybee's files of, and the names of these files, which have to be
// known before.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measuring/measurement.hpp"
#include "report/daylight_tables.hpp"

namespace photile::report {

/// The files that are written whatever the grids are.
inline constexpr std::array honeybee_tables{"grids_info.json", "grid_summary.csv"};

/// The file of each grid, `<grid>.res`: characters that a file's name should not have become `_`.
/// Errors: UsageError where two grids would share a name.
std::vector<std::string> honeybee_names(const std::vector<measuring::SensorGrid>& grids);

/// The files of a year of these grids, at most, by path in the folder.
///   states   of the blinds; 1 = there are none
/// Errors: UsageError where two grids have one name.
std::vector<std::string> annual_names(const std::vector<measuring::SensorGrid>& grids,
                                      std::size_t states);

/// The grids of measurement_json with the `identifier` of each.
nlohmann::ordered_json honeybee_record(const measuring::Measurement& measurement);

/// Names and counts of the grids, the hours with the sun up, and the states of the blinds. Writes
/// the lux of all hours to `values`, as python/photile/report/honeybee.py reads it. Errors:
/// OutputError.
nlohmann::ordered_json annual_record(const DaylightResults& results,
                                     const std::vector<daylight::SkyHour>& hours,
                                     const std::filesystem::path& values);

}  // namespace photile::report
