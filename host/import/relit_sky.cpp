#include "import/relit_sky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "daylight/perez_sky.hpp"
#include "daylight/sky_lights.hpp"
#include "daylight/sky_patches.hpp"
#include "daylight/sun_position.hpp"
#include "import/weather_file.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"

namespace photile::scene_io {
namespace {

using namespace daylight;

/// As many patches as the picture has. Errors: UsageError.
std::vector<SkyPatch> patches_of(const LightMix& mix) {
  std::size_t count = 0;
  const auto has = [&](const std::string& name) {
    return std::any_of(mix.lights.begin(), mix.lights.end(),
                       [&](const MixedLight& light) { return light.name == name; });
  };
  while (has(patch_name(count))) ++count;
  for (const int known : patch_counts) {
    if (count == static_cast<std::size_t>(known)) return sky_patches(known);
  }
  throw UsageError("--time: the picture has no patches of a sky; render it with --sky patches=145");
}

SkyIrradiance irradiance_of(SkySituation& situation, const std::optional<Sky>& sky) {
  SkyIrradiance irradiance;
  if (!situation.weather.empty()) {
    const WeatherYear year = read_weather(situation.weather);
    if (!situation.site) situation.site = year.site;
    irradiance = hour_at(year, *situation.time).irradiance;
  }
  if (sky) {
    if (sky->kind != SkyKind::perez)
      throw UsageError("--sky: patches take perez=DIRECT,DIFFUSE, such as perez=600,120");
    irradiance = {sky->direct_normal, sky->diffuse_horizontal};
  } else if (situation.weather.empty()) {
    throw UsageError("--time: no sky; give --weather FILE.epw or --sky perez=DIRECT,DIFFUSE");
  }
  if (!situation.site) throw UsageError("--time needs a place; give --site or --weather");
  return irradiance;
}

}  // namespace

std::vector<LightChange> sky_changes(const LightMix& mix, const SkySituation& asked,
                                     const std::optional<Sky>& given) {
  if (!asked.time) throw UsageError("--site, --weather and --sky need an hour; give --time");
  const std::vector<SkyPatch> patches = patches_of(mix);
  SkySituation situation = asked;
  const SkyIrradiance irradiance = irradiance_of(situation, given);
  const SunPosition sun = sun_position(*situation.site, *situation.time);
  const PerezSky sky(sun.elevation, irradiance, day_of_year(*situation.time));
  std::vector<double> luminance = patch_luminances(patches, sky, sun);
  double on_ground = sky.diffuse_illuminance();
  if (sun.elevation > 0) {
    on_ground += sky.direct_illuminance() * std::sin(sun.elevation);
    for (const auto& [patch, share] : sun_patches(patches, sun))
      luminance[patch] += share * sky.direct_illuminance() / patches[patch].solid_angle();
  }
  luminance.push_back(defaults::ground_reflectance * on_ground / glm::pi<double>());
  std::vector<LightChange> changes;
  for (std::size_t i = 0; i < luminance.size(); ++i) {
    const std::string name = i < patches.size() ? patch_name(i) : "ground";
    for (const MixedLight& light : mix.lights) {
      if (light.name != name) continue;
      const double scale = light.unit == PowerUnit::lumen ? 1.0 : 1.0 / mix.lumen_per_watt;
      const double factor = luminance[i] * scale;
      changes.push_back({name, factor > 0 ? fmt::format("x{:.9g}", factor) : "off"});
    }
  }
  return changes;
}

}  // namespace photile::scene_io
