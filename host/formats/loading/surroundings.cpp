#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "loading/finishing.hpp"
#include "loading/sky_situation.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "pictures/texture_decoder.hpp"
#include "scene/light_emission.hpp"
#include "weather/sky_lights.hpp"

namespace photile::loading {
namespace {

constexpr const char* fewer_lux = "give fewer lux";

void check_lux(const char* light, double lux) {
  if (lux >= limits::min_illuminance && lux <= limits::max_illuminance) return;
  throw UsageError(fmt::format("{} of {:g} lux: give {:g} at least and {:g} at most", light, lux,
                               limits::min_illuminance, limits::max_illuminance));
}

/// Of the light that was added last; `what` has said too much of it.
template <class Refusal>
void check_flux(const Scene& scene, const std::string& what, const char* remedy) {
  const Light& light = scene.lights.back();
  if (light.power <= limits::max_light_power) return;
  throw Refusal(
      fmt::format("{}: light '{}' emits {:.4g} {} into a scene of this size; the limit is "
                  "{:g}; {}",
                  what, light.name, light.power, scene.unit == PowerUnit::lumen ? "lm" : "W",
                  limits::max_light_power, remedy));
}

/// What is given in lux, in the scene's unit.
double in_scene_unit(double lux, const Scene& scene, const SceneLoadOptions& options) {
  return scene.unit == PowerUnit::lumen ? lux : lux / options.lumen_per_watt;
}

void add_picture(const EnvironmentPicture& picture, Scene& scene) {
  pictures::RadiancePicture read = pictures::read_radiance_picture(picture.file);
  std::size_t lost = 0;
  bool black = true;
  for (glm::vec3& texel : read.texels) {
    texel *= static_cast<float>(picture.scale);
    black = black && texel == glm::vec3(0.0f);
    lost += std::isfinite(texel.x) && std::isfinite(texel.y) && std::isfinite(texel.z) ? 0 : 1;
  }
  if (lost > 0) {
    throw InputError(
        fmt::format("{}: {} of its {} texels, times {:g}, are beyond any number; give a smaller "
                    "scale",
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

}  // namespace

void add_surroundings(Scene& scene, const SceneLoadOptions& options) {
  if (!options.environment.file.empty()) add_picture(options.environment, scene);
  const SkySituationLights found = sun_and_sky(options);
  if (found.sun) add_sun(*found.sun, options, scene);
  if (found.sky) add_sky(*found.sky, options, scene);
}

}  // namespace photile::loading
