// Patches of the sky at sensors, and years made of them, against closed forms.
#include "daylight/daylight_matrix.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "daylight/annual_daylight.hpp"
#include "daylight/light_transport.hpp"
#include "photile/errors.hpp"
#include "room_with_window.hpp"
#include "trace/distant_light.hpp"
#include "validation/analytic_cases.hpp"
#include "weather/sky_patches.hpp"

namespace photile::test {

using namespace daylight;

namespace {

using std::numbers::pi;
using Room = RoomWithWindow;

MatrixParameters quick(std::size_t patches) {
  MatrixParameters parameters;
  parameters.measuring.gathering.rays = 256;
  parameters.measuring.repeats = 4;
  parameters.mean_luminance.assign(patches + 1, 1000.0);
  return parameters;
}

}  // namespace

TEST_CASE("a direction has the patch that it points into") {
  for (const int count : weather::patch_counts) {
    const auto patches = weather::sky_patches(count);
    const weather::PatchFinder find(patches, 0.3);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const weather::SkyPatch& patch = patches[i];
      for (const double across : {0.01, 0.5, 0.99}) {
        for (const double up : {0.01, 0.99}) {
          const double azimuth =
              patch.azimuth_from + across * (patch.azimuth_to - patch.azimuth_from);
          const double sine = patch.sine_from + up * (patch.sine_to - patch.sine_from);
          REQUIRE(find(glm::vec3(weather::direction_of(azimuth + 0.3, std::asin(sine)))) == i);
        }
      }
    }
    CHECK(find({0.6f, -0.8f, 0.0f}) == patches.size());
  }
}

TEST_CASE("patches tile the sky: each direction has one light, found by its cell") {
  SceneBuilder builder("plate");
  builder.grid({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 1, builder.add(diffuse(0.0f)));
  builder.add(point_light("lamp", {0, 1, 0}));
  for (const int count : weather::patch_counts) {
    Scene scene = builder.build();
    weather::add_sky_lights(weather::sky_patches(count), 0.3, scene);
    const trace::DistantLights lights(scene);
    for (int i = 0; i < 2000; ++i) {
      const double sine = -0.999 + 1.998 * std::fmod(0.5 + i * 0.6180339887, 1.0);
      const double azimuth = 2 * pi * std::fmod(i * 0.7548776662, 1.0);
      const glm::vec3 direction(weather::direction_of(azimuth, std::asin(sine)));
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
  Scene scene = plate(diffuse(0.0f), 2);
  weather::add_sky_lights(weather::sky_patches(145), pi / 2, scene);
  const auto patch = std::find_if(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.name == weather::patch_name(0);
  });
  REQUIRE(patch != scene.lights.end());
  CHECK(trace::sees_disc(*patch, glm::normalize(glm::vec3(1.0f, 0.1f, 0.0f))));
}

TEST_CASE("all patches together are an even sky through a window") {
  Scene scene = Room::builder(diffuse(0.0f)).build();
  const auto patches = weather::sky_patches(145);
  scene.portals = {Room::window()};
  const Sensor sensor{{1.5, 0.8, 3.0}, {0, 0, -1}};
  const DaylightMatrix matrix =
      daylight_matrix(scene, std::span(&sensor, 1), patches, quick(patches.size()));
  double all = 0, straight = 0;
  for (std::size_t patch = 0; patch < matrix.patches; ++patch) {
    all += matrix.coefficient(0, patch);
    straight += double{matrix.straight[patch]};
  }
  const double truth =
      pi * validation::rectangle_factor(sensor.position, sensor.normal, {Room::left, Room::sill, 0},
                                        {1.2, 0, 0}, {0, 1, 0});
  CHECK(all == Approx(truth).epsilon(0.01));
  CHECK(straight == Approx(truth).epsilon(0.01));
}

TEST_CASE("reflected light adds to what comes straight, as paths find it") {
  // Rays that follow a coat scatter more.
  const auto [walls, material, tolerance] = GENERATE(table<std::string, Material, double>(
      {{"grey", diffuse(0.6f), 0.025},
       {"coloured", diffuse(glm::vec3(0.9f, 0.5f, 0.2f)), 0.025},
       {"coated", glossy(0.8f, 0.04f, 0.4f), 0.05}}));
  Scene scene = Room::builder(material).build();
  const auto patches = weather::sky_patches(145);
  Scene even = scene;
  add_environment(even, even_surroundings());
  scene.portals = even.portals = {Room::window()};
  // Far from the window, near it, and what looks away from it.
  const std::vector<Sensor> sensors{
      {{2.0, 0.8, 4.0}, {0, 1, 0}}, {{1.8, 0.8, 1.0}, {0, 1, 0}}, {{2.0, 1.2, 2.5}, {0, 0, 1}}};
  const DaylightMatrix matrix = daylight_matrix(scene, sensors, patches, quick(patches.size()));
  std::vector<double> paths(sensors.size(), 0.0);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto layers = gather_by_paths(even, sensors, {.rays = 8192}, seed).layers.dense();
    for (std::size_t i = 0; i < sensors.size(); ++i)
      paths[i] += double{layers.layers.at(0).illuminance.at(i)} * even.lights[0].power / 8;
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    double all = 0;
    for (std::size_t patch = 0; patch < matrix.patches; ++patch)
      all += matrix.coefficient(i, patch);
    CAPTURE(i, walls);
    CHECK(all == Approx(paths[i]).epsilon(tolerance));
    CHECK(double{matrix.relative_error[i]} > 1e-4);
    CHECK(double{matrix.relative_error[i]} < 0.03);
  }
}

TEST_CASE("stated errors are the scatter of seeds") {
  Scene scene = Room::builder(diffuse(0.5f)).build();
  scene.portals = {Room::window()};
  const auto patches = weather::sky_patches(145);
  const Sensor sensor{{2.0, 0.8, 3.5}, {0, 1, 0}};
  MatrixParameters parameters = quick(patches.size());
  parameters.measuring.gathering.rays = 64;
  constexpr int seeds = 24;
  double sum = 0, squares = 0, stated = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    parameters.measuring.photons.seed = static_cast<std::uint64_t>(seed);
    const DaylightMatrix matrix =
        daylight_matrix(scene, std::span(&sensor, 1), patches, parameters);
    double all = 0;
    for (std::size_t patch = 0; patch < matrix.patches; ++patch)
      all += matrix.coefficient(0, patch);
    sum += all;
    squares += all * all;
    stated += std::pow(double{matrix.relative_error[0]}, 2) / seeds;
  }
  const double mean = sum / seeds;
  const double scatter = std::sqrt((squares / seeds - mean * mean) * seeds / (seeds - 1)) / mean;
  CHECK(std::sqrt(stated) > 0.5 * scatter);
  CHECK(std::sqrt(stated) < 2.5 * scatter);
}

TEST_CASE("rows of few rays reflect no more light than surfaces do") {
  const bool coat = GENERATE(true, false);  // or a pane
  const glm::vec3 walls(0.9f);
  auto builder = Room::builder(coat ? glossy(walls, glm::vec3(0.04f), 0.5f) : diffuse(walls));
  const auto& [corner, u, v] = Room::window();
  if (!coat)
    builder.quad(corner, corner + u, corner + u + v, corner + v, builder.add(glass(1.5f, true)));
  Scene scene = builder.build();
  scene.portals = {Room::window()};
  const auto patches = weather::sky_patches(145);
  const Sensor sensor{{2.0, 0.8, 2.5}, {0, 1, 0}};
  const TransportParameters parameters{
      .rays = 32,
      .sky = {.max_specular_depth = 8},
      .mean_luminance = std::vector<double>(patches.size() + 1, 1000.0)};
  const RayScene rays(scene);
  const LightTransport transport = light_transport(
      rays, std::span(&sensor, 1), weather::PatchFinder(patches, 0), parameters, Progress::none());
  float most = 0;
  for (const TransportRow& row : transport.cells) {
    float sum = 0;
    for (const auto& entry : row.cells) sum += entry.weight.x;
    most = std::max(most, sum);
  }
  CHECK(most > 0.8f);
  CHECK(most < (coat ? 0.96f : 0.9001f));  // a coat adds at grazing angles
}

TEST_CASE("light that does not fade between surfaces is an error") {
  const auto between_two_cells = [](float reflected) {
    LightTransport transport{.sensors = {}, .cells = {}, .patches = 1, .batches = 1};
    const glm::vec3 sky(0.5f);
    const auto row = [&](std::uint32_t from) {
      return TransportRow{{{0, sky, sky}}, {{from, 0, glm::vec3(reflected)}}, {sky}};
    };
    transport.cells = {row(1), row(0)};
    transport.sensors = {TransportRow{{}, {{0, 0, glm::vec3(1.0f)}}, {glm::vec3(0.0f)}}};
    return transport;
  };
  for (const float reflected : {0.5f, 0.98f}) {
    const double truth = 0.5 / (1 - double{reflected});
    CHECK(lux_of_patches(between_two_cells(reflected)).at(0) == Approx(truth).epsilon(1e-3));
    CHECK(lux_of_batches(between_two_cells(reflected)).at(0).at(0) == Approx(truth).epsilon(1e-3));
  }
  for (const float reflected : {1.0f, 1.01f, 1.5f}) {
    CHECK_THROWS_WITH(lux_of_patches(between_two_cells(reflected)), Catch::Contains("not fade"));
    CHECK_THROWS_AS(lux_of_batches(between_two_cells(reflected)), InputError);
  }
}

TEST_CASE("a wall without thickness parts light, and a shelf above a floor") {
  // Two rooms of one floor and one ceiling: the sky shines into one of them.
  SceneBuilder builder("two rooms");
  const auto wall = builder.add(diffuse(0.7f));
  builder.grid({0, 0, 0}, {0, 0, 3}, {8, 0, 0}, 1, wall);
  builder.grid({0, 2.5f, 0}, {8, 0, 0}, {0, 0, 3}, 1, wall);
  builder.grid({0, 0, 0}, {0, 2.5f, 0}, {0, 0, 3}, 1, wall);
  builder.grid({4.03f, 0, 0}, {0, 2.5f, 0}, {0, 0, 3}, 1, wall);
  builder.grid({0, 0, 0}, {8, 0, 0}, {0, 2.5f, 0}, 1, wall);
  builder.grid({0, 0, 3}, {0, 2.5f, 0}, {8, 0, 0}, 1, wall);
  const Scene scene = builder.build();
  const auto patches = weather::sky_patches(145);
  const std::vector<Sensor> sensors{{{3.8, 0.8, 1.5}, {0, 1, 0}}, {{4.3, 0.8, 1.5}, {0, 1, 0}}};
  const DaylightMatrix matrix = daylight_matrix(scene, sensors, patches, quick(patches.size()));
  double dark = 0, lit = 0;
  for (std::size_t patch = 0; patch < matrix.patches; ++patch) {
    dark += matrix.coefficient(0, patch);
    lit += matrix.coefficient(1, patch);
  }
  CHECK(lit > 0.3);
  CHECK(dark == 0);
}

TEST_CASE("in the open an hour has its diffuse lux, and the sun's by its elevation") {
  const auto patches = weather::sky_patches(577);
  weather::WeatherYear weather{{48, 0, 0}, {}};
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
  for (const weather::SkyPatch& patch : patches) {
    const double sines = patch.sine_to * patch.sine_to - patch.sine_from * patch.sine_from;
    matrix.from_sky.push_back(
        static_cast<float>(0.5 * sines * (patch.azimuth_to - patch.azimuth_from)));
  }
  matrix.from_sky.push_back(0);
  matrix.straight = matrix.from_sky;
  SceneBuilder builder("far below");
  builder.grid({-1, -5, -1}, {0, 0, 2}, {2, 0, 0}, 1, builder.add(diffuse(0.0f)));
  builder.add(point_light("lamp", {0, 1, 0}));
  const Scene scene = builder.build();
  const Sensor sensor{{0, 0, 0}, {0, 1, 0}};
  const DirectLight straight(scene, std::span(&sensor, 1));
  const auto sun_by_rays = sun_profile(straight, hours, 0.4, 1.0);
  const auto by_rays = annual_profile(matrix, hours, patches, sun_by_rays);
  const auto by_patches = annual_profile(matrix, hours, patches, {});
  for (std::size_t h = 0; h < hours.size(); ++h) {
    const double sun = hours[h].sun_lux * std::max(0.0, std::sin(hours[h].sun.elevation));
    CHECK(double{by_rays[h]} == Approx(hours[h].diffuse_lux + sun).epsilon(2e-3).margin(1e-3));
    CHECK(double{sun_by_rays[h]} == Approx(sun).epsilon(1e-3).margin(1e-3));
    if (hours[h].sun.elevation > 0.2)
      CHECK(double{by_patches[h]} == Approx(hours[h].diffuse_lux + sun).epsilon(0.04));
  }
  CHECK(by_rays[12] > 10'000);
  CHECK(by_rays[1] == 0);
}

}  // namespace photile::test
