// Patches of the sky at sensors, and years made of them, against closed forms.
#include "daylight/daylight_matrix.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "daylight/annual_daylight.hpp"
#include "daylight/sky_lights.hpp"
#include "room_with_window.hpp"
#include "test_device.hpp"
#include "tools/validation/form_factors.hpp"
#include "trace/distant_light.hpp"

namespace photile::test {

using namespace photile::daylight;

namespace {

using std::numbers::pi;
using Room = RoomWithWindow;

MatrixParameters quick(std::size_t patches) {
  MatrixParameters parameters;
  parameters.measuring.gathering.rays = 512;
  parameters.measuring.repeats = 4;
  parameters.measuring.photons.photons.emitted_photons = 50'000;
  parameters.mean_luminance.assign(patches + 1, 1000.0);
  return parameters;
}

}  // namespace

TEST_CASE("patches tile the sky: each direction has one light, found by its cell") {
  SceneBuilder builder("plate");
  builder.grid({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 1, builder.add(diffuse(glm::vec3(0.0f))));
  builder.add(point_light("lamp", {0, 1, 0}));
  for (const int count : patch_counts) {
    Scene scene = builder.build();
    add_sky_lights(sky_patches(count), 0.3, scene);
    const trace::DistantLights lights(scene);
    for (int i = 0; i < 2000; ++i) {
      const double sine = -0.999 + 1.998 * std::fmod(0.5 + i * 0.6180339887, 1.0);
      const double azimuth = 2 * pi * std::fmod(i * 0.7548776662, 1.0);
      const glm::vec3 direction(direction_of(azimuth, std::asin(sine)));
      int all = 0, found = 0;
      for (const auto& light : lights) all += light.radiance(direction) != glm::vec3(0.0f) ? 1 : 0;
      for (const std::uint32_t index : lights.towards(direction))
        found += lights[index].radiance(direction) != glm::vec3(0.0f) ? 1 : 0;
      REQUIRE(all == 1);
      REQUIRE(found == 1);
    }
  }
}

TEST_CASE("north turns patches clockwise as seen from above") {
  Scene scene = plate(diffuse(glm::vec3(0.0f)), 2);
  add_sky_lights(sky_patches(145), pi / 2, scene);
  const auto patch = std::find_if(scene.lights.begin(), scene.lights.end(),
                                  [](const Light& light) { return light.name == patch_name(0); });
  REQUIRE(patch != scene.lights.end());
  CHECK(trace::sees_disc(*patch, glm::normalize(glm::vec3(1.0f, 0.1f, 0.0f))));
}

TEST_CASE("all patches together are an even sky through a window") {
  Scene scene = Room::builder(diffuse(glm::vec3(0.0f))).build();
  const auto patches = sky_patches(145);
  add_sky_lights(patches, 0, scene);
  scene.portals = {Room::window()};
  const Sensor sensor{{1.5, 0.8, 3.0}, {0, 0, -1}};
  MatrixParameters parameters = quick(patches.size());
  const DaylightMatrix matrix = daylight_matrix(scene, std::span(&sensor, 1), LightMix{}, patches,
                                                std::span(&device(), 1), parameters);
  double all = 0, straight = 0;
  for (std::size_t patch = 0; patch < matrix.patches; ++patch) {
    all += matrix.coefficient(0, patch);
    straight += double{matrix.straight[patch]};
  }
  const double truth =
      pi * validation::rectangle_factor(sensor.position, sensor.normal, {Room::left, Room::sill, 0},
                                        {1.2, 0, 0}, {0, 1, 0});
  CHECK(all == Approx(truth).epsilon(0.03));
  CHECK(straight == Approx(truth).epsilon(0.03));
}

TEST_CASE("reflected light adds to what comes straight, as in a furnace of paths") {
  Scene scene = Room::builder(diffuse(glm::vec3(0.6f))).build();
  const auto patches = sky_patches(145);
  Scene even = scene;
  add_environment(even, even_surroundings());
  add_sky_lights(patches, 0, scene);
  scene.portals = even.portals = {Room::window()};
  const Sensor sensor{{2.0, 0.8, 4.0}, {0, 1, 0}};
  const DaylightMatrix matrix = daylight_matrix(scene, std::span(&sensor, 1), LightMix{}, patches,
                                                std::span(&device(), 1), quick(patches.size()));
  double all = 0;
  for (std::size_t patch = 0; patch < matrix.patches; ++patch) all += matrix.coefficient(0, patch);
  double paths = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto layers =
        gather_by_paths(even, std::span(&sensor, 1), {.rays = 8192}, seed).layers.dense();
    paths += double{layers.layers.at(0).illuminance.at(0)} * even.lights[0].power / 8;
  }
  CHECK(all == Approx(paths).epsilon(0.05));
}

TEST_CASE("in the open an hour has its diffuse lux, and the sun's by its elevation") {
  const auto patches = sky_patches(577);
  scene_io::WeatherYear weather{{48, 0, 0}, {}};
  for (int hour = 0; hour < 24; ++hour)
    weather.hours.push_back(
        {6,
         21,
         hour + 0.5,
         {hour > 4 && hour < 19 ? 500.0 : 0.0, hour > 4 && hour < 19 ? 100.0 : 0.0}});
  const auto hours = sky_hours(weather, patches, 0.2);
  // A sensor that sees all of the sky, by hand.
  DaylightMatrix matrix;
  matrix.sensors = 1;
  matrix.patches = patches.size() + 1;
  for (const SkyPatch& patch : patches) {
    const double sines = patch.sine_to * patch.sine_to - patch.sine_from * patch.sine_from;
    matrix.from_sky.push_back(
        static_cast<float>(0.5 * sines * (patch.azimuth_to - patch.azimuth_from)));
  }
  matrix.from_sky.push_back(0);
  matrix.straight = matrix.from_sky;
  SceneBuilder builder("far below");
  builder.grid({-1, -5, -1}, {0, 0, 2}, {2, 0, 0}, 1, builder.add(diffuse(glm::vec3(0.0f))));
  builder.add(point_light("lamp", {0, 1, 0}));
  const Scene scene = builder.build();
  const Sensor sensor{{0, 0, 0}, {0, 1, 0}};
  const StraightLight straight(scene, std::span(&sensor, 1));
  const AnnualProfile by_rays = annual_profile(matrix, hours, patches, 0.4, 1.0, &straight);
  const AnnualProfile by_patches = annual_profile(matrix, hours, patches, 0.4, 1.0, nullptr);
  CHECK(by_patches.sun.empty());
  for (std::size_t h = 0; h < hours.size(); ++h) {
    const double sun = hours[h].sun_lux * std::max(0.0, std::sin(hours[h].sun.elevation));
    CHECK(double{by_rays.all[h]} == Approx(hours[h].diffuse_lux + sun).epsilon(2e-3).margin(1e-3));
    CHECK(double{by_rays.sun[h]} == Approx(sun).epsilon(1e-3).margin(1e-3));
    if (hours[h].sun.elevation > 0.2)
      CHECK(double{by_patches.all[h]} == Approx(hours[h].diffuse_lux + sun).epsilon(0.04));
  }
  CHECK(by_rays.all[12] > 10'000);
  CHECK(by_rays.all[1] == 0);
}

}  // namespace photile::test
