// Light at sensors in the air, against closed forms and against paths from surfaces.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/sensors.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

constexpr double pi = glm::pi<double>();
const glm::dvec3 up(0, 0, 1);

RenderParameters photons(std::uint64_t count, std::uint64_t seed) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = count;
  parameters.seed = seed;
  return parameters;
}

double luminous(const LightLayers& layers, std::size_t light, std::size_t sensor) {
  return static_cast<double>(layers.dense().layers.at(light).illuminance.at(sensor));
}

/// A black floor far below: light straight from lamps alone.
test::SceneBuilder dark_scene() {
  test::SceneBuilder builder("dark");
  builder.grid({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(test::diffuse(glm::vec3(0))));
  return builder;
}

/// The mean over 16 seeds of paths at one sensor, against the truth.
test::Verdict paths_give(const Scene& scene, const Sensor& sensor,
                         const GatherParameters& gathering, double truth, double delta) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    values.push_back(
        luminous(gather_by_paths(scene, std::span(&sensor, 1), gathering, seed).layers, 0, 0));
  }
  return test::mean_is(values, truth, delta);
}

}  // namespace

TEST_CASE("a point light gives I cos / d^2 in the air, on planes of any tilt") {
  test::SceneBuilder builder = dark_scene();
  const glm::dvec3 lamp(0.3, -0.2, 2.5);
  builder.add(test::point_light("lamp", glm::vec3(lamp)));
  const Scene scene = builder.build();
  std::vector<Sensor> sensors;
  for (const double tilt : {0.0, 0.4, 1.1, 2.0})
    sensors.push_back({{0.7, 0.4, 0.75}, {std::sin(tilt), 0, std::cos(tilt)}});
  const auto layers = gather_by_paths(scene, sensors, {.rays = 4}, 1).layers;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const glm::dvec3 way = lamp - sensors[i].position;
    const double distance = glm::length(way);
    const double cosine = std::max(0.0, glm::dot(way, sensors[i].normal) / distance);
    CHECK(luminous(layers, 0, i) ==
          Approx(cosine / (4 * pi * distance * distance)).epsilon(1e-5).margin(1e-9));
  }
}

TEST_CASE("cylindrical illuminance of a point light is I sin / (pi d^2)") {
  test::SceneBuilder builder = dark_scene();
  const glm::dvec3 lamp(1.5, 0.5, 2.0);
  builder.add(test::point_light("lamp", glm::vec3(lamp)));
  const Sensor sensor{{0, 0, 1.2}, up};
  const auto layers =
      gather_by_paths(builder.build(), std::span(&sensor, 1), {SensorResponse::cylindrical, 4}, 1)
          .layers;
  const glm::dvec3 way = lamp - sensor.position;
  const double d2 = glm::dot(way, way);
  const double sine = std::sqrt(1 - way.z * way.z / d2);
  CHECK(luminous(layers, 0, 0) == Approx(sine / (pi * 4 * pi * d2)).epsilon(1e-5));
}

TEST_CASE("each of several lamps is read alone, and sensors face away from what is behind") {
  test::SceneBuilder builder = dark_scene();
  builder.add(test::point_light("near", {0, 0, 1}));
  builder.add(test::point_light("far", {0, 0, 3}));
  builder.add(test::point_light("below", {0, 0, -1}));
  const Sensor sensor{{0, 0, 0}, up};
  // Equal lamps: each is looked at by a third of the rays exactly.
  const auto layers =
      gather_by_paths(builder.build(), std::span(&sensor, 1), {.rays = 300}, 5).layers;
  CHECK(luminous(layers, 0, 0) == Approx(1 / (4 * pi)).epsilon(1e-4));
  CHECK(luminous(layers, 1, 0) == Approx(1 / (36 * pi)).epsilon(1e-4));
  CHECK(luminous(layers, 2, 0) == 0);
}

TEST_CASE("an area light gives pi L times its form factor: a deviation of 1% would be seen") {
  test::SceneBuilder builder = dark_scene();
  const auto lamp = builder.add(test::area_light("lamp"));
  const glm::dvec3 corner(-0.5, -0.5, 1.5), u(0, 1, 0), v(1, 0, 0);  // faces down
  builder.grid(glm::vec3(corner), glm::vec3(u), glm::vec3(v), 1, 0, lamp);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.1, 1));
  const Sensor sensor{{0.4, 0.2, 0.6}, normal};
  const double truth =
      validation::rectangle_factor(sensor.position, normal, corner, u, v);  // 1 lm over 1 m2
  CHECK_VERDICT(paths_give(builder.build(), sensor, {.rays = 32768}, truth, 0.01 * truth));
}

TEST_CASE("in a furnace every sensor reads pi L / (1 - rho), planar and cylindrical") {
  constexpr double reflectance = 0.5;
  test::SceneBuilder builder("furnace");
  const auto wall = builder.add(test::diffuse(glm::vec3(static_cast<float>(reflectance))));
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), wall, true, 1,
              builder.add(test::area_light("walls")));
  const Scene scene = builder.build();
  const double truth = 1.0 / 6 / (1 - reflectance);  // 1 lm from 6 m2
  const Sensor sensor{{0.3, 0.6, 0.4}, glm::normalize(glm::dvec3(1, 2, -1))};
  const SensorResponse response = GENERATE(SensorResponse::planar, SensorResponse::cylindrical);
  SECTION("by photon maps") {
    std::vector<double> values;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      values.push_back(luminous(gather(scene, std::span(&sensor, 1), {response, 512},
                                       std::span(&test::device(), 1), photons(80'000, seed))
                                    .layers,
                                0, 0));
    }
    CHECK_VERDICT(test::mean_is(values, truth, 0.03 * truth));
  }
  SECTION("by paths") {
    CHECK_VERDICT(paths_give(scene, sensor, {response, 1024}, truth, 0.04 * truth));
  }
}

TEST_CASE("a sensor that sees no lamps reads what is reflected, and the sky") {
  constexpr double reflectance = 0.5, sky = 3;
  const bool closed = GENERATE(true, false);
  test::SceneBuilder builder("box or plate");
  const auto wall = builder.add(test::diffuse(glm::vec3(static_cast<float>(reflectance))));
  const auto lamp = builder.add(test::area_light("walls"));
  if (closed) {
    builder.box(glm::vec3(0.0f), glm::vec3(1.0f), wall, true, 1, lamp);
  } else {
    builder.grid({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, 1, builder.add(test::diffuse(glm::vec3(0.0f))),
                 lamp);
    builder.add(test::point_light("point", {0.2f, 0.3f, 1.0f}));
  }
  Scene scene = builder.build();
  if (!closed) {
    test::add_environment(scene,
                          EnvironmentMap("sky", 2, 1, std::vector<glm::vec3>(2, glm::vec3(sky))));
  }
  Sensor sensor{{0.3, 0.6, 0.4}, up};
  sensor.sees_lights = false;
  std::vector<double> values;
  double whole_sky = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layers = gather_by_paths(scene, std::span(&sensor, 1), {.rays = 4096}, seed).layers;
    double sum = luminous(layers, 0, 0);
    if (!closed) {
      CHECK(sum == 0);                     // the panel
      CHECK(luminous(layers, 1, 0) == 0);  // the point light
      sum = luminous(layers, 2, 0);
      whole_sky = scene.lights[2].power;
    }
    values.push_back(sum);
  }
  // The fraction of reflectance of a furnace's light is reflected; all but the panel's part of the
  // sky is visible.
  const double hidden =
      validation::rectangle_factor(sensor.position, up, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
  const double truth =
      closed ? reflectance / 6 / (1 - reflectance) : pi * sky * (1 - hidden) / whole_sky;
  CHECK_VERDICT(test::mean_is(values, truth, 0.05 * truth));
}

TEST_CASE("under an even sky a sensor reads pi L, a deviation of 1% would be seen") {
  constexpr double radiance = 5;
  Scene scene = test::plate(test::diffuse(glm::vec3(0)), 2);
  const EnvironmentMap map("even", 6, 3, std::vector<glm::vec3>(18, glm::vec3(radiance)));
  add_environment(scene, map);
  const double truth = pi * radiance / scene.lights.back().power;
  CHECK_VERDICT(paths_give(scene, {{0.2, 0.1, 0.5}, up}, {.rays = 4096}, truth, 0.01 * truth));
}

TEST_CASE("under half a sky cylinders read half of pi L, half cylinders by where they face") {
  // Bright where z > 0: the columns whose azimuths point there. The plate is too small to hide any.
  std::vector<glm::vec3> texels;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column)
      texels.emplace_back(column < 2 || column > 5 ? 1.0f : 0.0f);
  Scene scene = test::plate(test::diffuse(glm::vec3(0)), 0.01f);
  add_environment(scene, EnvironmentMap("half", 8, 4, texels));
  const double power = scene.lights.back().power;
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto check = [&](SensorResponse response, const glm::dvec3& normal,
                         const glm::dvec3& facing, double irradiance) {
    const Sensor sensor{.position = {0.3, 0.4, 0.5}, .normal = normal, .facing = facing};
    CHECK_VERDICT(
        paths_give(scene, sensor, {response, 2048}, irradiance / power, 0.07 * irradiance / power));
  };
  check(SensorResponse::cylindrical, z, x, pi / 2);
  check(SensorResponse::semi_cylindrical, z, x, pi / 2);
  check(SensorResponse::semi_cylindrical, y, x, pi / 2);
  // The integral of (1 + cos alpha) sine^2 over pi, where cos alpha is above 0, or below.
  check(SensorResponse::semi_cylindrical, y, z, (pi + 2) / 2);
  check(SensorResponse::semi_cylindrical, y, -z, (pi - 2) / 2);
}

TEST_CASE("sensors far outside the scene lie in its shadow") {
  Scene scene = test::plate(test::diffuse(glm::vec3(0)), 2);
  scene.lights = {test::sun_along({0, 0, -1}),
                  test::sun_along({0, 0, -1}, 0.01f, "sun with a disc")};
  const double shadowless = 1 / (pi * std::pow(bounding_sphere(scene).radius, 2));
  const std::vector<Sensor> sensors{{{0.1, 0.2, -40}, up}, {{3, 0.2, -40}, up}};
  const auto layers = gather_by_paths(scene, sensors, {.rays = 256}, 1).layers;
  for (std::size_t light = 0; light < 2; ++light) {
    CHECK(luminous(layers, light, 0) == 0);
    CHECK(luminous(layers, light, 1) == Approx(shadowless).epsilon(1e-3));
  }
}

TEST_CASE("a sensor that lies on a surface reads what paths find there") {
  const Scene scene = test::furnished_room();
  const std::vector<Sensor> sensors{{{1.0, 1.0, 0}, up}, {{3.5, 0.4, 0}, up}};
  std::vector<std::vector<double>> differences(2);
  std::vector<double> levels(2);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto maps =
        gather(scene, sensors, {.rays = 512}, std::span(&test::device(), 1), photons(100'000, seed))
            .layers;
    const auto paths = measure_by_paths(scene, sensors, 4096, seed).layers;
    for (std::size_t light = 0; light < 2; ++light) {
      double found = 0, gathered = 0;
      for (std::size_t i = 0; i < sensors.size(); ++i) {
        found += static_cast<double>(paths.layers[light].illuminance[i]);
        gathered += luminous(maps, light, i);
      }
      differences[light].push_back(gathered - found);
      levels[light] += found / 16;
    }
  }
  for (std::size_t light = 0; light < 2; ++light) {
    INFO("light " << light);
    CHECK_VERDICT(test::mean_is(differences[light], 0, 0.05 * levels[light]));
  }
}

TEST_CASE("a table keeps a lamp's light from a sensor below it") {
  test::SceneBuilder builder = dark_scene();
  builder.add(test::point_light("lamp", {0, 0, 2}));
  builder.grid({-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0}, 1, 0);
  const std::vector<Sensor> sensors{{{0, 0, 0.9}, up}, {{0, 0, 1.1}, up}};
  const auto layers = gather_by_paths(builder.build(), sensors, {.rays = 16}, 1).layers;
  CHECK(luminous(layers, 0, 0) == 0);
  CHECK(luminous(layers, 0, 1) == Approx(1 / (4 * pi * 0.81)).epsilon(1e-4));
}

TEST_CASE("a sensor reads the same with others beside it") {
  const Scene scene = test::furnished_room();
  const std::vector<Sensor> both{{{1.0, 1.0, 0.75}, up}, {{3.5, 0.4, 0.75}, up}};
  const auto together = gather_by_paths(scene, both, {.rays = 64}, 3).layers;
  const auto alone = gather_by_paths(scene, std::span(both).first(1), {.rays = 64}, 3).layers;
  CHECK(luminous(together, 0, 0) == luminous(alone, 0, 0));
}

TEST_CASE("numbers of rays and sensors out of range are refused") {
  const Scene scene = test::furnished_room();
  const Sensor sensor{{1, 1, 1}, up};
  CHECK_THROWS_WITH(gather_by_paths(scene, std::span(&sensor, 1), {.rays = 0}, 1),
                    Catch::Contains("rays: 0"));
  CHECK_THROWS_WITH(gather_by_paths(scene, {}, {.rays = 1}, 1), Catch::Contains("sensors: 0"));
}

}  // namespace photile::test
