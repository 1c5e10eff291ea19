// Lamps without size close to surface: the light of their hot spots at sensors, against quadrature
// of closed forms and against photons from the lamp.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "lamp_below_ceiling.hpp"
#include "photile/photons.hpp"
#include "photile/sensors.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

double luminous_of_layer(const LightLayers& layers, std::size_t light, std::size_t sensor) {
  return static_cast<double>(layers.dense().layers.at(light).illuminance.at(sensor));
}

using Measure = std::function<LightLayers(const Scene&, std::span<const Sensor>, std::uint64_t)>;

LightLayers by_paths(const Scene& scene, std::span<const Sensor> sensors, std::uint64_t seed) {
  return gather_by_paths(scene, sensors, {.rays = 256}, seed).layers;
}

LightLayers by_photons(const Scene& scene, std::span<const Sensor> sensors, std::uint64_t seed) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 20'000;
  parameters.seed = seed;
  return gather(scene, sensors, {.rays = 256}, std::span(&device(), 1), parameters).layers;
}

LightLayers by_light_maps(const Scene& scene, std::span<const Sensor> sensors, std::uint64_t seed) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 20'000;
  parameters.light_maps = LightMapMode::on;
  parameters.light_map_rays = 16;
  parameters.seed = seed;
  return gather(scene, sensors, {.rays = 256}, std::span(&device(), 1), parameters).layers;
}

std::vector<double> of_16_seeds(const Measure& measure, const Scene& scene, const Sensor& sensor,
                                std::size_t light = 0) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed)
    values.push_back(luminous_of_layer(measure(scene, std::span(&sensor, 1), seed), light, 0));
  return values;
}

constexpr double hot_spot_pi = glm::pi<double>();
const Sensor desk{{0.4, -0.7, 0.75}, {0, 0, 1}};

}  // namespace

TEST_CASE("hot spots: a lamp millimetres below a ceiling lights the desk as its spot does") {
  // Farther from the lamp less of its light is that of its hot spot, and the rest scatters.
  const auto [below, seen] = GENERATE(std::pair{0.001f, 0.03}, std::pair{0.003f, 0.03},
                                      std::pair{0.01f, 0.04}, std::pair{0.05f, 0.16});
  SceneBuilder builder = ceiling_and_floor();
  const Light lamp = point_light("lamp", {0.1f, 0.2f, ceiling_height - below});
  builder.add(lamp);
  const Scene scene = builder.build();
  const double truth = lux_below_ceiling(scene, lamp, desk.position);
  CAPTURE(below, truth);
  CHECK_VERDICT(mean_is(of_16_seeds(by_paths, scene, desk), truth, seen * truth));
  CHECK_VERDICT(mean_is(of_16_seeds(by_photons, scene, desk), truth, seen * truth));
  CHECK_VERDICT(mean_is(of_16_seeds(by_light_maps, scene, desk), truth, seen * truth));
}

TEST_CASE("hot spots: one lamp of twenty is close to the ceiling, one shines at it in a beam") {
  SceneBuilder builder = ceiling_and_floor();
  const Light close = point_light("close", {0.1f, 0.2f, ceiling_height - 0.01f});
  const Light beam =
      spot_light("beam", {-0.5f, 0.5f, ceiling_height - 0.01f}, {0.6f, 0.0f, 0.8f}, 0.02f, 0.03f);
  builder.add(close);
  builder.add(beam);
  for (int i = 0; i < 18; ++i) {
    builder.add(
        point_light("lamp " + std::to_string(i), {0.2f * static_cast<float>(i) - 1.8f, 0, 1.5f}));
  }
  const Scene scene = builder.build();
  // All of the beam meets a spot of a millimetre.
  const glm::dvec3 lit = glm::dvec3(beam.position) + 0.01 / 0.8 * glm::dvec3(beam.direction);
  const glm::dvec3 down = lit - desk.position;
  const double of_beam = ceiling_albedo / hot_spot_pi * down.z * down.z /
                         (glm::dot(down, down) * glm::dot(down, down));
  for (const auto& [light, truth] :
       {std::pair{0, lux_below_ceiling(scene, close, desk.position)}, std::pair{1, of_beam}}) {
    const auto layer = static_cast<std::size_t>(light);
    CAPTURE(light, truth);
    CHECK_VERDICT(mean_is(of_16_seeds(by_paths, scene, desk, layer), truth, 0.3 * truth));
    CHECK_VERDICT(mean_is(of_16_seeds(by_photons, scene, desk, layer), truth, 0.3 * truth));
  }
}

TEST_CASE("hot spots: what leaves a white box around a lamp is that of photons from it") {
  // Open below, 6 cm wide: most light that leaves it has been reflected several times within.
  SceneBuilder builder("box");
  const std::uint32_t white = builder.add(diffuse(glm::vec3(0.8f)));
  const float s = 0.03f, top = 2.5f, bottom = top - 0.08f;
  const glm::vec3 x(2 * s, 0, 0), y(0, 2 * s, 0), z(0, 0, top - bottom), low(-s, -s, bottom);
  builder.grid(low + z, y, x, 1, white);
  builder.grid(low, y, z, 1, white);
  builder.grid(low, z, x, 1, white);
  builder.grid(low + x, z, y, 1, white);
  builder.grid(low + y, x, z, 1, white);
  builder.grid({-ceiling_half_side, -ceiling_half_side, 0}, {2 * ceiling_half_side, 0, 0},
               {0, 2 * ceiling_half_side, 0}, 1, builder.add(diffuse(glm::vec3(0.0f))));
  builder.add(point_light("lamp", {0.005f, 0, top - 0.004f}));
  const Scene scene = builder.build();

  const Photons photons =
      trace_photons(RayScene(scene), {.emitted_photons = 400'000, .store_direct = false}).photons;
  double landed = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    if (photons.position[i].z < 1) landed += luminance(glm::dvec3(photons.flux[i]));
  }
  const glm::dvec3 lamp(scene.lights[0].position);
  std::vector<Sensor> floor;
  double direct = 0;
  constexpr int columns = 8;
  constexpr double cell = 2 * double{ceiling_half_side} / columns;
  for (int i = 0; i < columns * columns; ++i) {
    const glm::dvec3 at((i % columns + 0.5) * cell - double{ceiling_half_side},
                        (i / columns + 0.5) * cell - double{ceiling_half_side}, 0.001);
    floor.push_back({at, {0, 0, 1}});
    const glm::dvec3 way = lamp - at, out = at + (double{bottom} - at.z) / way.z * way;
    if (std::max(std::abs(out.x), std::abs(out.y)) > double{s}) continue;
    direct += way.z / (4 * hot_spot_pi * std::pow(glm::length(way), 3));
  }
  const Measure measure = GENERATE(Measure(by_paths), Measure(by_photons));
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const LightLayers layers = measure(scene, floor, seed);
    double all = 0;
    for (std::size_t i = 0; i < floor.size(); ++i) all += luminous_of_layer(layers, 0, i);
    values.push_back((all - direct) * cell * cell);
  }
  CHECK_VERDICT(mean_is(values, landed, 0.15 * landed));
}

TEST_CASE("hot spots: a lamp in the plane of a ceiling shines as one just below it") {
  const glm::vec3 where(0.1f, 0.2f, ceiling_height);
  const Light down = spot_light("down", where, {0, 0, -1}, 0.5f, 0.9f);
  const Light both = point_light("both ways", where);
  const auto scene_with = [](const Light& lamp) {
    SceneBuilder builder = ceiling_and_floor();
    builder.add(lamp);
    return builder.build();
  };
  const Scene alone = scene_with(down), scene = scene_with(both);
  for (const Measure& measure : {Measure(by_paths), Measure(by_photons)}) {
    CHECK(luminous_of_layer(measure(alone, std::span(&desk, 1), 1), 0, 0) ==
          Approx(lux_below_ceiling(alone, down, desk.position)).epsilon(1e-3));
    const double truth = lux_below_ceiling(scene, both, desk.position);
    CHECK_VERDICT(mean_is(of_16_seeds(measure, scene, desk), truth, 0.03 * truth));
  }
}

}  // namespace photile::test
