#include "publish/light_choices.hpp"

#include <algorithm>
#include <optional>

#include "loading/surroundings.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"

namespace photile::publish {

using nlohmann::json;

Preset preset_of(const std::string& name, const LightMix& mix,
                 const std::vector<LightChange>& changes) {
  Preset preset{name, mix, std::vector<double>(mix.lights.size())};
  change_lights(preset.mix, changes);
  for (const LightChange& change : changes) {
    if (!change.value.ends_with('K')) continue;
    for (std::size_t i = 0; i < mix.lights.size(); ++i) {
      if (mix.lights[i].name == change.name) preset.kelvins[i] = std::stod(change.value);
    }
  }
  return preset;
}

json to_json(const std::vector<Preset>& presets) {
  json list = json::array();
  for (const Preset& preset : presets) {
    json lights = json::array();
    for (std::size_t i = 0; i < preset.mix.lights.size(); ++i) {
      const MixedLight& light = preset.mix.lights[i];
      lights.push_back({{"light", i},
                        {"power", light.power},
                        {"tint", {light.tint.x, light.tint.y, light.tint.z}},
                        {"kelvin", preset.kelvins.empty() ? 0.0 : preset.kelvins[i]}});
    }
    list.push_back({{"name", preset.name}, {"lights", lights}});
  }
  return list;
}

SkyHours sky_hours(const LightMix& mix, const SkySituation& situation) {
  SkyHours hours;
  const std::vector<weather::SkyPatch> patches = loading::patches_of(mix);
  std::optional<weather::WeatherYear> year;
  if (!situation.weather.empty()) year = weather::read_weather(situation.weather);
  const std::optional<Site> site = situation.site ? situation.site
                                   : year         ? std::optional(year->site)
                                                  : std::nullopt;
  if (patches.empty() || !site) return hours;
  hours.lights = patches.size() + 1;
  for (int half = 0; half < 48; ++half) hours.times.push_back(half / 2.0);
  LocalTime time;
  if (situation.time) time.year = situation.time->year;
  hours.year = time.year;
  hours.weather = year.has_value();
  time.day = 21;
  for (time.month = 1; time.month <= 12; ++time.month) {
    const int day = weather::day_of_year(time);
    hours.days.push_back(day);
    for (const double hour : hours.times) {
      time.hour = hour;
      const weather::WeatherHour* const row = year ? &weather::hour_at(*year, time) : nullptr;
      const weather::SunPosition sun =
          weather::sun_position(*site, row ? weather::middle_of(*row, time) : time);
      const weather::SkyIrradiance irradiance =
          row ? row->irradiance : weather::clear_sky(sun.elevation, day);
      const auto found = weather::sky_luminances(patches, sun, irradiance, day);
      hours.luminances.insert(hours.luminances.end(), found.begin(), found.end());
    }
  }
  hours.start_day = situation.time ? weather::day_of_year(*situation.time) : hours.days[5];
  hours.start_time = situation.time ? std::min(2 * situation.time->hour, 47.0) : 24;
  return hours;
}

}  // namespace photile::publish
