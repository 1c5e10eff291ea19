#include "loading/relit_sky.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photile/errors.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_lights.hpp"
#include "weather/sky_patches.hpp"
#include "weather/sun_position.hpp"
#include "weather/weather_file.hpp"

namespace photile::loading {
namespace {

weather::SkyIrradiance irradiance_of(SkySituation& situation, const std::optional<Sky>& sky) {
  if (!situation.weather.empty()) {
    const weather::WeatherYear year = weather::read_weather(situation.weather);
    if (!situation.site) situation.site = year.site;
    if (!sky) return weather::hour_at(year, *situation.time).irradiance;
  }
  if (!situation.site) throw UsageError("--time needs a place; give --site or --weather");
  if (!sky) {
    const weather::SunPosition sun = weather::sun_position(*situation.site, *situation.time);
    return weather::clear_sky(sun.elevation, weather::day_of_year(*situation.time));
  }
  if (sky->kind != SkyKind::perez)
    throw UsageError("--sky: patches take perez=DIRECT,DIFFUSE, such as perez=600,120");
  return {sky->direct_normal, sky->diffuse_horizontal};
}

}  // namespace

std::vector<weather::SkyPatch> patches_of(const LightMix& mix) {
  std::size_t count = 0;
  const auto has = [&](const std::string& name) {
    return std::any_of(mix.lights.begin(), mix.lights.end(),
                       [&](const MixedLight& light) { return light.name == name; });
  };
  while (has(weather::patch_name(count))) ++count;
  for (const int known : weather::patch_counts) {
    if (count == static_cast<std::size_t>(known)) return weather::sky_patches(known);
  }
  return {};
}

std::string sky_light_name(std::size_t light, std::size_t patches) {
  return light < patches ? weather::patch_name(light) : "ground";
}

std::vector<LightChange> sky_changes(const LightMix& mix, const SkySituation& asked,
                                     const std::optional<Sky>& given) {
  if (!asked.time) throw UsageError("--site, --weather and --sky need an hour; give --time");
  const std::vector<weather::SkyPatch> patches = patches_of(mix);
  if (patches.empty()) {
    throw UsageError(
        "--time: the picture has no patches of a sky; render it with --sky patches=145");
  }
  SkySituation situation = asked;
  const weather::SkyIrradiance irradiance = irradiance_of(situation, given);
  const std::vector<double> luminance =
      weather::sky_luminances(patches, weather::sun_position(*situation.site, *situation.time),
                              irradiance, weather::day_of_year(*situation.time));
  std::vector<LightChange> changes;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    const std::string name = sky_light_name(i, patches.size());
    for (const MixedLight& light : mix.lights) {
      if (light.name != name) continue;
      const double scale = light.unit == PowerUnit::lumen ? 1.0 : 1.0 / mix.lumen_per_watt;
      const double factor = luminance[i] * scale;
      changes.push_back({name, factor > 0 ? fmt::format("x{:.9g}", factor) : "off"});
    }
  }
  return changes;
}

}  // namespace photile::loading
