// A year of daylight in the folder that Honeybee's recipe for annual daylight leaves.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/daylight_tables.hpp"

namespace photile::report {

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
