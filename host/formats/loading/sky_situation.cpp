#include "loading/sky_situation.hpp"

#include <numbers>

#include "loading/sky_map.hpp"
#include "photile/errors.hpp"
#include "weather/sun_position.hpp"
#include "weather/weather_file.hpp"

namespace photile::loading {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr int even_day =
    80;  ///< of a sky without a date: the Earth at its mean distance, or nearly

/// The options with the weather of their hour: its place, and its sky where none is given.
SceneLoadOptions with_weather(SceneLoadOptions options) {
  SkySituation& situation = options.situation;
  if (situation.weather.empty()) return options;
  if (!situation.time) {
    throw UsageError("--weather says nothing without an hour; give --time, too");
  }
  const weather::WeatherYear year = weather::read_weather(situation.weather);
  if (!situation.site) situation.site = year.site;
  if (!options.sky) {
    const weather::SkyIrradiance& irradiance = weather::hour_at(year, *situation.time).irradiance;
    options.sky = Sky{SkyKind::perez, 0, irradiance.direct_normal, irradiance.diffuse_horizontal};
  }
  return options;
}

/// The sun as the time places it, without light. Nothing where no time is given.
std::optional<Sun> sun_by_time(const SkySituation& situation) {
  if (!situation.time && !situation.site) return std::nullopt;
  if (!situation.time) throw UsageError("--site says nothing without a time; give --time, too");
  if (!situation.site) {
    throw UsageError("--time says nothing without a place; give --site or --weather, too");
  }
  const weather::SunPosition position = weather::sun_position(*situation.site, *situation.time);
  return Sun{position.azimuth * degrees, position.elevation * degrees, 0};
}

/// Adds the sky and the sun of its irradiances.
void add_perez(const Sky& asked, const SkySituation& situation, const std::optional<Sun>& place,
               SkySituationLights& lights) {
  if (!place) {
    throw UsageError("a Perez sky needs the sun's place; give --sun, or --site and --time");
  }
  const int day = situation.time ? weather::day_of_year(*situation.time) : even_day;
  SkyLight sky{SkyKind::perez};
  sky.perez.emplace(place->elevation_degrees / degrees,
                    weather::SkyIrradiance{asked.direct_normal, asked.diffuse_horizontal}, day);
  sky.illuminance = sky.perez->diffuse_illuminance();
  Sun shown = *place;
  shown.elevation_degrees =
      90 - weather::zenith_of_sun(place->elevation_degrees / degrees) * degrees;
  sky.to_sun = direction_to(shown);
  if (sky.illuminance > 0) lights.sky = sky;
  const double direct = sky.perez->direct_illuminance();
  if (!lights.sun && direct > 0 && place->elevation_degrees > 0) {
    lights.sun = *place;
    lights.sun->illuminance = direct;
  }
}

}  // namespace

SkySituationLights sun_and_sky(const SceneLoadOptions& given) {
  const SceneLoadOptions options = with_weather(given);
  const double north = options.situation.north_degrees;
  std::optional<Sun> place = sun_by_time(options.situation);
  SkySituationLights lights;
  if (options.sun) {
    if (options.sun->placed_by_time && !place)
      throw UsageError("--sun with its lux alone needs --site and --time");
    if (!options.sun->placed_by_time && place)
      throw UsageError(
          "--sun AZIMUTH,ELEVATION,LUX and --time both place the sun; give its lux "
          "alone, or leave out --time");
    lights.sun = options.sun;
    if (place) {
      lights.sun->azimuth_degrees = place->azimuth_degrees;
      lights.sun->elevation_degrees = place->elevation_degrees;
    }
    lights.sun->azimuth_degrees += north;
    place = lights.sun;
    if (options.sun->placed_by_time && !(place->elevation_degrees > 0)) lights.sun.reset();
  } else if (place) {
    place->azimuth_degrees += north;
  }
  if (!options.sky) return lights;
  if (options.sky->kind == SkyKind::perez) {
    add_perez(*options.sky, options.situation, place, lights);
    return lights;
  }
  SkyLight sky{options.sky->kind, options.sky->illuminance};
  sky.patches = options.sky->patches;
  sky.north = north / degrees;
  if (sky.kind == SkyKind::clear) {
    if (!place || !(place->elevation_degrees > 0.0)) {
      throw UsageError("a clear sky needs a sun above the horizon; give one, too");
    }
    sky.to_sun = direction_to(*place);
  }
  lights.sky = sky;
  return lights;
}

}  // namespace photile::loading
