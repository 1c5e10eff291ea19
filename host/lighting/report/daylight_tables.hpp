// A year of daylight as figures, and as text: lines, CSV, JSON.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daylight/daylight_metrics.hpp"
#include "daylight/sky_states.hpp"
#include "measuring/measurement.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/sensors.hpp"

namespace photile::report {

/// A grid with its year. Profiles are those of its sensors.
struct GridDaylight {
  measuring::SensorGrid grid;
  std::vector<daylight::PointDaylight> points;
  daylight::RoomDaylight room;
  std::vector<float> relative_error;        ///< of each sensor's mean
  std::vector<float> lux, sun;              ///< by sensor, then hour; `sun` may be empty
  std::vector<daylight::LampEnergy> lamps;  ///< empty where there are none
  /// Where it was made of several rounds.
  std::optional<daylight::DaylightErrors> errors;
};

/// One state of the blinds all year.
struct DaylightState {
  std::string name;
  std::vector<GridDaylight> grids;
};

struct DaylightResults {
  std::size_t rounds = 1;           ///< that the figures are means of
  double outdoor_lux = 0;           ///< as median_outdoors
  std::vector<GridDaylight> grids;  ///< with blinds, where there are some, as they close
  // Without blinds empty.
  std::vector<DaylightState> states;
  std::vector<std::size_t> state_of_hour;
};

/// What the numbers were asked for.
struct DaylightAsked {
  double target_lux = 300;
  daylight::Occupancy occupancy;
  std::vector<bool> occupied;  ///< by the hour
  double ground = defaults::ground_reflectance;
};

/// The scene's lamps at full power.
struct YearLamps {
  std::vector<LightIlluminance> lux = {};  ///< of each, at the sensors of the year
  std::vector<double> watts = {};          ///< that each takes
  double target_lux = 0;                   ///< that they maintain together
};

/// Measures the scene's own lamps: not the light from beyond it. Errors: those of
/// measure_illuminance.
///   efficacy   lm/W of lamps whose files state no power
YearLamps year_lamps(const Scene& scene, std::span<const Sensor> sensors, const LightMix& mix,
                     double target_lux, double efficacy, std::span<Device> devices,
                     const MeasuringParameters& parameters, Progress& progress);

/// By the schedule of the blinds, with the sun as it is without them (IES LM-83), then in each of
/// their states.
/// With several rounds, figures have standard errors, except those of a single state.
///   rounds   of states as sky_states has them
DaylightResults daylight_results(const DaylightAsked& asked, const daylight::Year& year,
                                 const std::vector<measuring::SensorGrid>& grids,
                                 const daylight::SkyRounds& rounds, const YearLamps& lamps = {});

/// What to say where next to no light of the sky reaches any point: less than 0.1%.
///   most_percent   of the points: per cent of the light on open ground
/// Empty where there is more.
std::string darkness_warning(double most_percent);

/// Makes daylight factors, in per cent, of what was measured under a sky of 100 lux: those of all
/// its light. Notes a darkness_warning.
void keep_daylight_factors(measuring::Measurement& measurement, Progress& progress);

/// "sDA 300,50% 62.1 +-0.8%: meets 55% (certain)": which of the two levels of IES LM-83 are met,
/// 55% or 75% of the points, and whether three standard errors leave a doubt.
std::string autonomy_text(const GridDaylight& grid, const DaylightAsked& asked, std::size_t rounds);

std::vector<std::string> daylight_lines(const DaylightResults& results, const DaylightAsked& asked);
/// With a column for the state of the blinds where there are some.
std::string daylight_csv(const DaylightResults& results, const DaylightAsked& asked);
nlohmann::ordered_json daylight_json(const DaylightResults& results, const DaylightAsked& asked);

}  // namespace photile::report
