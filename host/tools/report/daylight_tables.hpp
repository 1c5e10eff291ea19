// A year of daylight as text: lines, CSV, JSON, Honeybee's files.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daylight/daylight_metrics.hpp"
#include "measuring/sensor_grid.hpp"

namespace photile::measuring {

/// A grid with its year. Profiles are those of its sensors.
struct GridDaylight {
  SensorGrid grid;
  std::vector<daylight::PointDaylight> points;
  daylight::RoomDaylight room;
  std::vector<float> relative_error;        ///< of each sensor's mean
  std::vector<float> lux, sun;              ///< by sensor, then hour; `sun` may be empty
  std::vector<daylight::LampEnergy> lamps;  ///< empty where there are none
};

/// What the numbers were asked for.
struct DaylightAsked {
  double wanted_lux = 300;
  daylight::Occupancy occupancy;
};

std::vector<std::string> daylight_lines(const std::vector<GridDaylight>& grids,
                                        const DaylightAsked& asked);
std::string daylight_csv(const std::vector<GridDaylight>& grids);
nlohmann::ordered_json daylight_json(const std::vector<GridDaylight>& grids,
                                     const DaylightAsked& asked);

/// As Honeybee's annual recipe leaves them: `<grid>.ill`, a line for each sensor with the lux of
/// each hour with the sun up; `<grid>_direct.ill` of the sun alone, where it is known;
/// `sun-up-hours.txt`, hours of the year; `grids_info.json`. By name. Errors: UsageError where two
/// grids have one name.
std::map<std::string, std::string> annual_files(const std::vector<GridDaylight>& grids,
                                                const std::vector<daylight::SkyHour>& hours);

}  // namespace photile::measuring
