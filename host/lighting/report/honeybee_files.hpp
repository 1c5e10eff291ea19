// Results in the files that Honeybee and Ladybug Tools read.
#pragma once

#include <array>
#include <map>
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

/// Name -> content: `<grid>.res` with the lux of a sensor on each line, `grids_info.json` with the
/// grids' `name`, `identifier`, `full_id`, `group` and `count`, and `grid_summary.csv` as
/// honeybee-radiance-postprocess writes it (uniformity in per cent).
/// Errors: UsageError where two grids would share a name.
std::map<std::string, std::string> honeybee_files(const measuring::Measurement& measurement);

/// The files that annual_files writes of these grids, at most, by path in the folder.
///   states   of the blinds; 1 = there are none
/// Errors: UsageError where two grids have one name.
std::vector<std::string> annual_names(const std::vector<measuring::SensorGrid>& grids,
                                      std::size_t states);

/// By path in the folder:
/// - `grids_info.json`, `sun-up-hours.txt` (hours of the year);
/// - `<grid>.ill`, a line for each sensor with the lux of each hour with the sun up, and
///   `<grid>_direct.ill` of the sun alone, where it is known;
/// - the same as NumPy arrays of floats, which honeybee-radiance-postprocess reads:
///   `__static_apertures__/default/total/<grid>.npy` and `.../direct/<grid>.npy`. Blinds are an
///   aperture group of the name `blinds`: `blinds/<state>/total/<grid>.npy` and so on, with
///   `grid_states.json` and, of a common year, `states_schedule.json`.
/// Errors: UsageError where two grids have one name.
std::map<std::string, std::string> annual_files(const DaylightResults& results,
                                                const std::vector<daylight::SkyHour>& hours);

}  // namespace photile::report
