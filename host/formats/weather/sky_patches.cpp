#include "weather/sky_patches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "photile/defaults.hpp"
#include "scene/light_emission.hpp"

namespace photile::weather {

namespace {

using std::numbers::pi;

}  // namespace

glm::dvec3 direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
          -std::cos(elevation) * std::cos(azimuth)};
}

std::vector<SkyPatch> sky_patches(int count) {
  constexpr std::array<int, 7> in_row{30, 30, 24, 24, 18, 12, 6};
  const int parts = count <= 145 ? 1 : count <= 577 ? 2 : 4;
  const double height = pi / 2 / (7 * parts + 0.5);
  std::vector<SkyPatch> patches;
  for (int row = 0; row < 7 * parts; ++row) {
    const int number = in_row[static_cast<std::size_t>(row / parts)] * parts;
    const double width = 2 * pi / number;
    for (int i = 0; i < number; ++i) {
      patches.push_back({(i - 0.5) * width, (i + 0.5) * width, std::sin(height * row),
                         std::sin(height * (row + 1)), i * width, height * (row + 0.5)});
    }
  }
  patches.push_back({0, 2 * pi, std::sin(height * 7 * parts), 1, 0, pi / 2});
  return patches;
}

PatchFinder::PatchFinder(const std::vector<SkyPatch>& patches, double north)
    : patches_(patches.size()), north_(static_cast<float>(north)) {
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (i > 0 && patches[i].sine_from == patches[i - 1].sine_from) {
      rows_.back().number += 1;
    } else {
      const double width = patches[i].azimuth_to - patches[i].azimuth_from;
      rows_.push_back({static_cast<std::uint32_t>(i), 1, static_cast<float>(1 / width)});
    }
  }
  rows_per_radian_ = static_cast<float>(1 / (2 * patches.front().elevation));
}

std::uint32_t PatchFinder::operator()(const glm::vec3& direction) const {
  if (direction.y < 0.0f) return static_cast<std::uint32_t>(patches_);
  const float elevation = std::asin(std::min(1.0f, direction.y));
  const Row& row =
      rows_[std::min(static_cast<std::size_t>(elevation * rows_per_radian_), rows_.size() - 1)];
  // The middle of a row's first patch is north; a cap is one patch.
  float column = (std::atan2(direction.x, -direction.z) - north_) * row.per_radian + 0.5f;
  column -= std::floor(column / row.number) * row.number;
  return row.first + static_cast<std::uint32_t>(std::min(column, row.number - 1));
}

SkyInPatches::SkyInPatches(const std::vector<SkyPatch>& patches) {
  for (const SkyPatch& patch : patches) {
    middles_.emplace_back(direction_of(patch.azimuth, patch.elevation));
    sines_.push_back(static_cast<float>(std::sin(patch.elevation)));
    horizontal_.push_back(static_cast<float>(std::sin(patch.elevation) * patch.solid_angle()));
  }
}

std::vector<float> SkyInPatches::luminances(const PerezSky& sky, const SunPosition& sun) const {
  const glm::vec3 to_sun(direction_of(sun.azimuth, pi / 2 - zenith_of_sun(sun.elevation)));
  std::vector<float> luminances(middles_.size());
  double horizontal = 0;
  float sine = -1, gradation = 0;
  for (std::size_t i = 0; i < middles_.size(); ++i) {
    if (sines_[i] != sine) {  // the same all along a row
      sine = sines_[i];
      gradation = sky.gradation(sine);
    }
    luminances[i] = std::max(0.0f, gradation * sky.indicatrix(glm::dot(to_sun, middles_[i])));
    horizontal += double{luminances[i] * horizontal_[i]};
  }
  if (!(horizontal > 0)) {  // the model is dark everywhere
    std::fill(luminances.begin(), luminances.end(), 1.0f);
    horizontal = pi;
  }
  const auto scale = static_cast<float>(sky.diffuse_illuminance() / horizontal);
  for (float& luminance : luminances) luminance *= scale;
  return luminances;
}

std::vector<PatchShare> SkyInPatches::sun(const SunPosition& sun) const {
  constexpr std::size_t nearest = 4;
  const glm::vec3 to_sun(direction_of(sun.azimuth, sun.elevation));
  std::array<PatchShare, nearest> shares{};  // from the nearest on
  for (std::size_t i = 0; i < middles_.size(); ++i) {
    const double share = 1 / (1.002 - double{glm::dot(to_sun, middles_[i])});
    if (share <= shares.back().share) continue;
    std::size_t place = nearest - 1;
    for (; place > 0 && shares[place - 1].share < share; --place) shares[place] = shares[place - 1];
    shares[place] = {i, share};
  }
  double sum = 0;
  for (const PatchShare& share : shares) sum += share.share;
  for (PatchShare& share : shares) share.share /= sum;
  return {shares.begin(), shares.end()};
}

namespace {

using std::numbers::pi;

/// Flux that a patch of this solid angle and 1 cd/m2 sends through the disc of the scene's bounding
/// sphere.
double patch_flux(const Scene& scene, double solid_angle) {
  return scene::directional_flux(solid_angle, bounding_sphere(scene).radius);
}

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
  add_ground_light(1, scene);
  return first;
}

void add_ground_light(double radiance, Scene& scene) {
  add_patch("ground", {0, 2 * pi, -1, 0}, scene);
  scene.lights.back().power *= radiance;
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

}  // namespace photile::weather
