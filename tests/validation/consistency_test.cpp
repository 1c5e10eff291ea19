// Photon maps come closer to the truth as photons grow, at the rate that theory gives, and are
// right to 1% where the light is uniform. Noise is taken from independent seeds.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/sensors.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr double pi = glm::pi<double>();

/// count x count sensors, `spacing` metres apart, around the origin in z = 0.
std::vector<Sensor> square_of_sensors(int count, double spacing, const glm::dvec3& normal) {
  std::vector<Sensor> sensors;
  for (int i = 0; i < count * count; ++i) {
    const double middle = 0.5 * (count - 1);
    sensors.push_back(
        {{spacing * (i % count - middle), spacing * (i / count - middle), 0}, normal});
  }
  return sensors;
}

RenderParameters with(std::uint64_t photons, int neighbours, std::uint64_t seed) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.seed = seed;
  parameters.neighbours = neighbours;
  return parameters;
}

/// Illuminance at sensors, of each light at its power in turn.
std::vector<std::vector<double>> readings(const Scene& scene, const std::vector<Sensor>& sensors,
                                          const RenderParameters& parameters) {
  const RenderResult result = measure(scene, sensors, std::span(&test::device(), 1), parameters);
  std::vector<std::vector<double>> all;
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    std::vector<double>& values = all.emplace_back();
    for (const float value : result.layers.layers[light].illuminance) {
      values.push_back(scene.lights[light].power * static_cast<double>(value));
    }
  }
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// A plate of 2 x 2 m in parallel light from above: 1 / (2 pi) of the flux on each square metre,
/// the disc of the bounding sphere having the radius sqrt(2) m.
Scene evenly_lit_plate() {
  Scene scene = test::plate(test::diffuse(glm::vec3(0.0f)), 2.0f, 2);
  scene.lights.push_back(test::sun_along({0, 0, -1}));
  return scene;
}

/// count x count discs side by side read even light without bias.
void check_even_light(int count, double spacing, std::uint64_t photons, int neighbours,
                      double delta) {
  const Scene scene = evenly_lit_plate();
  const std::vector<Sensor> sensors = square_of_sensors(count, spacing, {0, 0, 1});
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    values.push_back(mean(readings(scene, sensors, with(photons, neighbours, seed))[0]));
  }
  const double truth = 1 / (2 * pi);
  CHECK_VERDICT(test::mean_is(values, truth, delta * truth));
}

}  // namespace

TEST_CASE("even light is read without bias: a deviation of 1% would be seen", "[slow]") {
  check_even_light(20, 0.08, 500'000, 400, 0.01);
}

TEST_CASE("few neighbours are as unbiased as many: k for k - 1 would be seen") {
  check_even_light(40, 0.04, 100'000, 10, 0.03);  // k for k - 1 gives 11% more
}

TEST_CASE("the squared error falls as photons to the power -2/3 where k grows as to the power 2/3",
          "[slow]") {
  // The variance is 1 / k and the bias is of the order of k / N, whose square falls faster.
  const Scene scene = evenly_lit_plate();
  const std::vector<Sensor> sensors = square_of_sensors(16, 0.08, {0, 0, 1});
  const double truth = 1 / (2 * pi);
  const std::vector<double> photons{10'000, 40'000, 160'000, 640'000};
  std::vector<double> slopes;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    // Least squares through the points (log N, log of the squared error).
    double products = 0, squares = 0;
    for (const double count : photons) {
      const int k = static_cast<int>(std::lround(20 * std::pow(count / 10'000, 2.0 / 3)));
      const auto read =
          readings(scene, sensors, with(static_cast<std::uint64_t>(count), k, seed))[0];
      double error = 0;
      for (const double value : read) {
        error += std::pow(value / truth - 1, 2) / static_cast<double>(sensors.size());
      }
      const double x = std::log(count / std::sqrt(photons.front() * photons.back()));
      products += x * std::log(error);
      squares += x * x;
    }
    slopes.push_back(products / squares);
  }
  CHECK_VERDICT(test::mean_is(slopes, -2.0 / 3, 0.1));
}

TEST_CASE("interreflected light is read without bias in the middle of a wall", "[slow]") {
  // Roulette has to give survivors what it takes from the others. All walls glow and reflect.
  test::SceneBuilder builder;
  const std::uint32_t wall = builder.add(test::diffuse(glm::vec3(0.8f)));
  const std::uint32_t lamp = builder.add(test::area_light("walls", pi * 6));
  builder.box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1}, wall, true, 1, lamp);
  const Scene scene = builder.build();
  const std::vector<Sensor> sensors = square_of_sensors(10, 0.06, {0, 0, 1});
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    values.push_back(mean(readings(scene, sensors, with(300'000, 450, seed))[0]));
  }
  const double truth = pi / (1 - 0.8);
  CHECK_VERDICT(test::mean_is(values, truth, 0.02 * truth));
}

TEST_CASE("each light of two is read at its own power", "[slow]") {
  Scene scene = test::plate(test::diffuse(glm::vec3(0.0f)), 2.0f, 2);
  for (const double power : {100.0, 3.0}) {
    scene.lights.push_back(test::sun_along({0, 0, -1}, 0, "sun of " + std::to_string(power)));
    scene.lights.back().power = power;
  }
  const std::vector<Sensor> sensors = square_of_sensors(20, 0.08, {0, 0, 1});
  std::vector<double> first, second;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = with(1'000'000, 800, seed);
    parameters.photons.quota = PhotonQuota::equal;
    const auto both = readings(scene, sensors, parameters);
    first.push_back(mean(both[0]));
    second.push_back(mean(both[1]));
  }
  CHECK_VERDICT(test::mean_is(first, 100 / (2 * pi), 0.015 * 100 / (2 * pi)));
  CHECK_VERDICT(test::mean_is(second, 3 / (2 * pi), 0.015 * 3 / (2 * pi)));
}

TEST_CASE("the unlit side of a lit plate, and a dark wall beside it, read nothing") {
  // The wall stands along the light: photons of the floor lie within reach of its foot.
  test::SceneBuilder builder;
  const std::uint32_t black = builder.add(test::diffuse(glm::vec3(0.0f)));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, black);
  builder.grid({0.5f, -1, 0}, {0, 0, 1}, {0, 2, 0}, 2, black);
  builder.add(test::sun_along({0, 0, -1}));
  const Scene scene = builder.build();
  std::vector<Sensor> sensors = square_of_sensors(5, 0.1, {0, 0, -1});
  for (int i = 0; i < 10; ++i) {
    sensors.push_back({{0.5, 0.05 * i, 0.01}, {-1, 0, 0}});
    sensors.push_back({{0.5, 0.05 * i, 0.01}, {1, 0, 0}});
  }
  const std::vector<double> dark = readings(scene, sensors, with(100'000, 50, 1))[0];
  CHECK(dark == std::vector<double>(sensors.size(), 0.0));
  CHECK(readings(scene, {{{0, 0, 0}, {0, 0, 1}}}, with(100'000, 50, 1))[0][0] > 0);
}

}  // namespace photile::test
