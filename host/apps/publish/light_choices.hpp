// What a page offers for its lights: presets, and the sky of an hour.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"

namespace photile::publish {

/// Light settings by a name that people choose from.
struct Preset {
  std::string name;
  LightMix mix;
  std::vector<double> kelvins;  ///< per light: the colour temperature that was asked for; 0 = none
};

/// The preset of a mood. Errors: those of change_lights.
Preset preset_of(const std::string& name, const LightMix& mix,
                 const std::vector<LightChange>& changes);
/// As the page has them.
nlohmann::json to_json(const std::vector<Preset>& presets);

/// The luminances of a sky in patches over the hours of some days.
struct SkyHours {
  int year = 0;
  std::vector<int> days;           ///< of that year, from 1
  std::vector<double> times;       ///< hours from midnight, of each day
  std::vector<double> luminances;  ///< cd/m2: [day][time][patch], the ground last
  std::size_t lights = 0;          ///< patches, and the ground
  int start_day = 0;               ///< that the page opens with ...
  double start_time = 0;           ///< ... and the place in `times`
  bool weather = false;            ///< the sky is that of a weather file
};

/// The 21st of each month, each half hour, for the patches of the mix; empty where it has none, or
/// where no place is known. The sky is clear, or that of the weather file's hours.
/// Errors: those of read_weather.
SkyHours sky_hours(const LightMix& mix, const SkySituation& situation);

}  // namespace photile::publish
