#include "weather/sky_lights.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "photile/defaults.hpp"
#include "scene/light_emission.hpp"

namespace photile::weather {
namespace {

using std::numbers::pi;

void add_patch(std::string name, const glm::dvec4& bounds, Scene& scene) {
  Light light;
  light.name = std::move(name);
  light.kind = LightKind::directional;
  light.direction = glm::vec3(0.0f, -1.0f, 0.0f);
  light.sky_patch = glm::vec4(bounds);
  light.power = patch_flux(scene, (bounds.y - bounds.x) * (bounds.w - bounds.z));
  scene.lights.push_back(std::move(light));
}

}  // namespace

std::string patch_name(std::size_t patch) { return fmt::format("sky_{:04}", patch + 1); }

std::size_t add_sky_lights(const std::vector<SkyPatch>& patches, double north, Scene& scene) {
  const std::size_t first = scene.lights.size();
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const SkyPatch& patch = patches[i];
    add_patch(
        patch_name(i),
        {patch.azimuth_from + north, patch.azimuth_to + north, patch.sine_from, patch.sine_to},
        scene);
  }
  add_patch("ground", {0, 2 * pi, -1, 0}, scene);
  return first;
}

std::vector<double> sky_luminances(const std::vector<SkyPatch>& patches, const SunPosition& sun,
                                   const SkyIrradiance& irradiance, int day) {
  const PerezSky sky(sun.elevation, irradiance, day);
  const SkyInPatches in_patches(patches);
  const std::vector<float> found = in_patches.luminances(sky, sun);
  std::vector<double> luminances(found.begin(), found.end());
  double on_ground = sky.diffuse_illuminance();
  if (sun.elevation > 0) {
    on_ground += sky.direct_illuminance() * std::sin(sun.elevation);
    for (const auto& [patch, share] : in_patches.sun(sun)) {
      luminances[patch] += share * sky.direct_illuminance() / patches[patch].solid_angle();
    }
  }
  luminances.push_back(defaults::ground_reflectance * on_ground / pi);
  return luminances;
}

double patch_flux(const Scene& scene, double solid_angle) {
  return scene::directional_flux(solid_angle, bounding_sphere(scene).radius);
}

}  // namespace photile::weather
