#include "loading/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "pictures/textures.hpp"
#include "scene/light_emission.hpp"
#include "weather/weather_file.hpp"

namespace photile::loading {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr int even_day =
    80;  ///< of a sky without a date: the Earth at its mean distance, or nearly

/// Takes the row of the weather file that covers the situation's time, and the middle of its hour
/// for that time.
weather::SkyIrradiance take_row(const weather::WeatherYear& year, SkySituation& situation) {
  const weather::WeatherHour& row = weather::hour_at(year, *situation.time);
  situation.time = weather::middle_of(row, *situation.time);
  return row.irradiance;
}

/// The situation of the options with the weather of their hour.
struct Weathered {
  SceneLoadOptions options;                           ///< with the file's site, and its sky
  std::optional<weather::SkyIrradiance> of_row = {};  ///< where no sky was given
};

/// Takes the site of the weather file, and where no sky is given its sky and the middle of its
/// hour.
Weathered with_weather(const SceneLoadOptions& given) {
  Weathered result{given};
  SkySituation& situation = result.options.situation;
  if (situation.weather.empty()) return result;
  if (!situation.time) {
    throw UsageError("--weather needs an hour; also give --time");
  }
  const weather::WeatherYear year = weather::read_weather(situation.weather);
  if (!situation.site) situation.site = year.site;
  if (result.options.sky) return result;
  result.of_row = take_row(year, situation);
  result.options.sky =
      Sky{SkyKind::perez, 0, result.of_row->direct_normal, result.of_row->diffuse_horizontal};
  return result;
}

/// The sun as the time places it, without light. Nothing where no time is given.
std::optional<Sun> sun_by_time(const SkySituation& situation) {
  if (!situation.time && !situation.site) return std::nullopt;
  if (!situation.time) throw UsageError("--site needs a time; also give --time");
  if (!situation.site) {
    throw UsageError("--time needs a place; also give --site or --weather");
  }
  const weather::SunPosition position = weather::sun_position(*situation.site, *situation.time);
  return Sun{position.azimuth * degrees, position.elevation * degrees, 0};
}

/// Adds the sky and the sun of irradiances.
void add_perez(const weather::SkyIrradiance& irradiance, const SkySituation& situation,
               const std::optional<Sun>& place, SkySituationLights& lights) {
  if (!place) {
    throw UsageError("a Perez sky needs the sun's position; give --sun, or --site and --time");
  }
  const int day = situation.time ? weather::day_of_year(*situation.time) : even_day;
  SkyLight sky{SkyKind::perez};
  sky.perez.emplace(place->elevation_degrees / degrees, irradiance, day);
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
  const auto [options, of_row] = with_weather(given);
  const double north = options.situation.north_degrees;
  std::optional<Sun> place = sun_by_time(options.situation);
  SkySituationLights lights;
  if (options.sun) {
    if (options.sun->placed_by_time && !place)
      throw UsageError("--sun LUX needs --site and --time");
    if (!options.sun->placed_by_time && place)
      throw UsageError(
          "--sun AZIMUTH,ELEVATION,LUX and --time both place the sun; give only its lux, or leave "
          "out --time");
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
    const weather::SkyIrradiance stated{options.sky->direct_normal,
                                        options.sky->diffuse_horizontal};
    add_perez(of_row.value_or(stated), options.situation, place, lights);
    return lights;
  }
  SkyLight sky{options.sky->kind, options.sky->illuminance};
  sky.patches = options.sky->patches;
  sky.north = north / degrees;
  if (sky.kind == SkyKind::clear) {
    if (!place || !(place->elevation_degrees > 0.0)) {
      throw UsageError(
          "a clear sky needs a sun above the horizon; give --sun, or --site and --time");
    }
    sky.to_sun = direction_to(*place);
  }
  lights.sky = sky;
  return lights;
}

namespace {

using std::numbers::pi;
constexpr int rows = 512;  // a third of a degree each
constexpr int columns = 1024;
/// Columns of a map that does not depend on the azimuth: portals show some of them more than
/// others.
constexpr int even_columns = 64;

/// Luminance of a clear sky over a factor that is the same everywhere: ISO 15469, type 12.
double clear_luminance(const glm::dvec3& direction, const glm::dvec3& to_sun) {
  constexpr double a = -1, b = -0.32, c = 10, d = -3, e = 0.45;
  const double cosine = std::clamp(glm::dot(direction, to_sun), -1.0, 1.0);
  const double from_sun = std::acos(cosine);
  const double gradation = 1 + a * std::exp(b / std::max(direction.y, 1e-9));
  const double indicatrix =
      1 + c * (std::exp(d * from_sun) - std::exp(d * pi / 2)) + e * cosine * cosine;
  return gradation * indicatrix;
}

/// Sine of the elevation of the upper border of a row.
double sine_above(int row) { return std::cos(pi * row / rows); }

}  // namespace

glm::dvec3 direction_to(const Sun& sun) {
  const double azimuth = sun.azimuth_degrees * pi / 180,
               elevation = sun.elevation_degrees * pi / 180;
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          -std::cos(elevation) * std::cos(azimuth)};
}

EnvironmentMap sky_map(SkyKind kind, double illuminance, const glm::dvec3& to_sun,
                       const weather::PerezSky* perez) {
  const bool by_azimuth = kind == SkyKind::clear || kind == SkyKind::perez;
  const int width = by_azimuth ? columns : even_columns;
  const EnvironmentMap places("sky", width, rows,
                              std::vector<glm::vec3>(static_cast<std::size_t>(width * rows)));
  std::vector<double> texels;
  double horizontal = 0;  // illuminance
  for (int row = 0; row < rows / 2; ++row) {
    const double above = sine_above(row), below = sine_above(row + 1);
    for (int column = 0; column < width; ++column) {
      double value = 1;
      // The mean over the row, exactly, so that the closed form of the illuminance holds.
      if (kind == SkyKind::overcast) value = 1 + above + below;
      if (kind == SkyKind::perez) {
        const glm::dvec3 direction = places.direction_at(column + 0.5, row, 0.5);
        value = double{perez->relative_luminance(static_cast<float>(direction.y),
                                                 static_cast<float>(glm::dot(direction, to_sun)))};
      }
      if (kind == SkyKind::clear)
        value = clear_luminance(places.direction_at(column + 0.5, row, 0.5), to_sun);
      texels.push_back(value);
      horizontal += value * pi / width * (above * above - below * below);
    }
  }
  if (!(horizontal > 0)) return sky_map(SkyKind::uniform, illuminance, to_sun);
  std::vector<glm::vec3> scaled(static_cast<std::size_t>(width * rows), glm::vec3(0.0f));
  for (std::size_t i = 0; i < texels.size(); ++i) {
    scaled[i] = glm::vec3(static_cast<float>(texels[i] * illuminance / horizontal));
  }
  return {"sky", width, rows, std::move(scaled)};
}

namespace {

constexpr const char* fewer_lux = "give fewer lux";

void check_lux(const char* light, double lux) {
  if (lux >= limits::min_illuminance && lux <= limits::max_illuminance) return;
  throw UsageError(fmt::format("{} of {:g} lux: give {:g} to {:g} lux", light, lux,
                               limits::min_illuminance, limits::max_illuminance));
}

/// Refuses the light that was added last where its power is beyond the limit; `what` names its
/// origin.
template <class Refusal>
void check_flux(const Scene& scene, const std::string& what, const char* remedy) {
  const Light& light = scene.lights.back();
  if (light.power <= limits::max_light_power) return;
  throw Refusal(fmt::format(
      "{}: light '{}' emits {:.4g} {} into a scene of this size; the limit is "
      "{:g}; {}",
      what, light.name, light.power, symbol_of(scene.unit), limits::max_light_power, remedy));
}

/// A value given in lux, in the scene's unit.
double in_scene_unit(double lux, const Scene& scene, const SceneLoadOptions& options) {
  return in_unit(lux, PowerUnit::lumen, scene.unit, options.lumen_per_watt);
}

void add_picture(const EnvironmentPicture& picture, const SceneLoadOptions& options, Scene& scene) {
  pictures::RadiancePicture read = pictures::read_radiance_picture(picture.file);
  const double scale =
      read.in_candela ? in_scene_unit(picture.scale, scene, options) : picture.scale;
  std::size_t lost = 0;
  bool black = true;
  for (glm::vec3& texel : read.texels) {
    texel *= static_cast<float>(scale);
    black = black && texel == glm::vec3(0.0f);
    lost += std::isfinite(texel.x) && std::isfinite(texel.y) && std::isfinite(texel.z) ? 0 : 1;
  }
  if (lost > 0) {
    throw InputError(fmt::format(
        "{}: {} of its {} texels overflow when multiplied by {:g}; give a smaller scale",
        picture.file.string(), lost, read.texels.size(), picture.scale));
  }
  const auto refuse_black = [&] {
    throw InputError(fmt::format("{}: the environment is black; give another, or a larger scale",
                                 picture.file.string()));
  };
  if (black) refuse_black();  // before a table of its texels is made
  EnvironmentMap map(picture.file.filename().string(), read.width, read.height,
                     std::move(read.texels), picture.rotation_degrees);
  if (!(luminance(map.integral()) > 0.0)) refuse_black();
  scene::add_environment_light("environment", std::move(map), scene);
  check_flux<InputError>(scene, picture.file.string(), "give a smaller scale");
}

void add_sun(const Sun& sun, const SceneLoadOptions& options, Scene& scene) {
  check_lux("sun", sun.illuminance);
  const double diameter = sun.diameter_degrees * std::numbers::pi / 180.0;
  Light light;
  light.name = "sun";
  light.kind = LightKind::directional;
  light.direction = -glm::vec3(direction_to(sun));
  light.angular_diameter = static_cast<float>(diameter);
  light.power = scene::distant_flux(in_scene_unit(sun.illuminance, scene, options), diameter,
                                    bounding_sphere(scene).radius);
  scene.lights.push_back(std::move(light));
  check_flux<UsageError>(scene, fmt::format("sun of {:g} lux", sun.illuminance), fewer_lux);
}

void add_sky(const SkyLight& sky, const SceneLoadOptions& options, Scene& scene) {
  if (sky.kind == SkyKind::patches) {
    weather::add_sky_lights(weather::sky_patches(sky.patches), sky.north, scene);
    return;
  }
  check_lux("sky", sky.illuminance);
  scene::add_environment_light("sky",
                               sky_map(sky.kind, in_scene_unit(sky.illuminance, scene, options),
                                       sky.to_sun, sky.perez ? &*sky.perez : nullptr),
                               scene);
  check_flux<UsageError>(scene, fmt::format("sky of {:g} lux", sky.illuminance), fewer_lux);
}

void add_ground(const SkySituationLights& lights, const SceneLoadOptions& options, Scene& scene) {
  const double of_default = options.ground / defaults::ground_reflectance;
  if (lights.sky && lights.sky->kind == SkyKind::patches) {
    scene.lights.back().power *= of_default;
    if (of_default == 0) scene.lights.pop_back();
    return;
  }
  double lux = lights.sky ? lights.sky->illuminance : 0.0;
  if (lights.sun) lux += lights.sun->illuminance * std::max(0.0, direction_to(*lights.sun).y);
  if (options.ground == 0 || (of_default == 1 && !(lux > 0))) return;
  if (!(lux > 0)) {
    throw UsageError("ground: nothing lights it; give --sky or --sun, or leave out ground");
  }
  weather::add_ground_light(in_scene_unit(options.ground * lux / pi, scene, options), scene);
  check_flux<UsageError>(scene, fmt::format("ground under {:g} lux", lux), fewer_lux);
}

}  // namespace

void add_surroundings(Scene& scene, const SceneLoadOptions& options) {
  if (!options.environment.file.empty()) add_picture(options.environment, options, scene);
  const SkySituationLights found = sun_and_sky(options);
  if (found.sun) add_sun(*found.sun, options, scene);
  if (found.sky) add_sky(*found.sky, options, scene);
  add_ground(found, options, scene);
}

std::optional<double> ground_reflectance(const SceneLoadOptions& options) {
  if (!options.sky && !options.sun && !options.situation.time) return std::nullopt;
  return options.ground;
}

std::vector<std::pair<std::string, std::string>> sky_facts(const SceneLoadOptions& options) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (const auto ground = ground_reflectance(options)) {
    facts.emplace_back("ground", fmt::format("reflectance {:g} below the horizon{}", *ground,
                                             *ground > 0 ? "" : ", which is black"));
  }
  const SkySituation& situation = options.situation;
  if (situation.weather.empty() || !situation.time || options.sky) return facts;
  const weather::WeatherYear year = weather::read_weather(situation.weather);
  const weather::WeatherHour& row = weather::hour_at(year, *situation.time);
  const int hour = static_cast<int>(std::lround(row.hour + 0.5));
  facts.emplace_back(
      "weather",
      fmt::format("{}, row {}/{} hour {}, which covers {}:00 to {}:00: {:g} W/m2 direct normal, "
                  "{:g} W/m2 diffuse; the sun stands where it is at {}:30",
                  situation.weather.filename().string(), row.month, row.day, hour, hour - 1, hour,
                  row.irradiance.direct_normal, row.irradiance.diffuse_horizontal, hour - 1));
  return facts;
}

namespace {

weather::SkyIrradiance irradiance_of(SkySituation& situation, const std::optional<Sky>& sky) {
  if (!situation.weather.empty()) {
    const weather::WeatherYear year = weather::read_weather(situation.weather);
    if (!situation.site) situation.site = year.site;
    if (!sky) return take_row(year, situation);
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

std::vector<std::uint32_t> patch_of_layers(const LightMix& mix) {
  std::vector<std::uint32_t> patch_of(mix.lights.size(), none);
  const std::size_t count = patches_of(mix).size();
  for (std::size_t patch = 0; count > 0 && patch <= count; ++patch) {
    for (std::size_t i = 0; i < mix.lights.size(); ++i) {
      if (mix.lights[i].name == sky_light_name(patch, count)) {
        patch_of[i] = static_cast<std::uint32_t>(patch);
      }
    }
  }
  return patch_of;
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
