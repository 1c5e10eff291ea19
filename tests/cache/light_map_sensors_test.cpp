// Sensors that read light maps, beside the estimate at each point and closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>
#include <vector>

#include "gathering.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

RenderParameters parameters_of(LightMapMode mode, int rays = 0) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 200'000;
  parameters.neighbours = 200;
  parameters.light_maps = mode;
  parameters.light_map_rays = rays;
  return parameters;
}

std::span<Device> one_device() { return {&test::device(), 1}; }

/// Nodes that a run has valued.
double nodes_of(const RenderResult& result) {
  for (const StageStatistics& stage : result.statistics) {
    if (stage.stage == "light maps") return stage.figures.front().second;
  }
  return 0;
}

/// Illuminance of all lights of a result, per sensor.
std::vector<double> lux_of(const RenderResult& result) {
  const LightLayers layers = result.layers.dense();
  std::vector<double> lux(layers.layers.front().illuminance.size(), 0.0);
  for (const LightLayers::Layer& layer : layers.layers) {
    for (std::size_t i = 0; i < lux.size(); ++i) lux[i] += double{layer.illuminance[i]};
  }
  return lux;
}

/// A grid of sensors on the plane z = 0, facing up.
std::vector<Sensor> grid_on_floor(double side, int count) {
  std::vector<Sensor> sensors;
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) {
      sensors.push_back(
          {{((x + 0.5) / count - 0.5) * side, ((y + 0.5) / count - 0.5) * side, 0.0}, {0, 0, 1}});
    }
  }
  return sensors;
}

/// Mean of the squares of relative errors.
double error_of(const std::vector<double>& values, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += std::pow(values[i] / truth[i] - 1, 2);
  return sum / static_cast<double>(values.size());
}

/// A closed room of 2 m on a yard of 8 m under an even sky. Its walls are sheets, or boxes, or
/// sheets that stand above the ceiling.
Scene room_in_a_yard(float thickness, float above) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.add(diffuse(glm::vec3(0.7f)));
  builder.grid({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1, paint);
  builder.grid({-1, -1, 1.5f}, {2, 0, 0}, {0, 2, 0}, 1, paint);
  const float side = 1 + thickness, height = 1.5f + above;
  for (const float end : {-1.0f, 1.0f}) {
    if (thickness > 0) {
      const float low = std::min(end, end * side), high = std::max(end, end * side);
      builder.box({low, -side, 0}, {high, side, height}, paint, false);
      builder.box({-1, low, 0}, {1, high, height}, paint, false);
    } else {
      builder.grid({end, -1, 0}, {0, 2, 0}, {0, 0, height}, 1, paint);
      builder.grid({-1, end, 0}, {2, 0, 0}, {0, 0, height}, 1, paint);
    }
  }
  builder.add_surroundings("sky", EnvironmentMap("sky", 1, 1, {glm::vec3(1.0f)}));
  return builder.build();
}

/// Light in the cavity of a closed room's double shell: a panel that faces the ceiling from above,
/// or a lamp in the gap of double walls.
Scene room_in_a_shell(float gap, bool panel_above) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.add(diffuse(glm::vec3(0.7f)));
  builder.box({0, 0, 0}, {4, 4, 3}, paint, true);
  const std::uint32_t black = builder.add(diffuse(glm::vec3(0.0f)));
  if (panel_above) {
    builder.grid({1.7f, 1.7f, 3 + gap}, {0, 0.6f, 0}, {0.6f, 0, 0}, 1, black,
                 builder.add(area_light("panel")));
  } else {
    builder.box({-gap, -gap, -gap}, {4 + gap, 4 + gap, 3 + gap}, paint, true);
    builder.add(point_light("cavity", {2, 2, 3 + 0.5f * gap}));
  }
  return builder.build();
}

}  // namespace

TEST_CASE("No light comes through the walls of a closed room") {
  const auto [thickness, above] =
      GENERATE(std::pair{0.0f, 0.0f}, std::pair{0.1f, 0.0f}, std::pair{0.0f, 0.4f});
  const auto [mode, rays] =
      GENERATE(std::pair{LightMapMode::automatic, 0}, std::pair{LightMapMode::on, 0},
               std::pair{LightMapMode::on, 64});
  CAPTURE(thickness, above, rays, name_of(mode));
  const Scene scene = room_in_a_yard(thickness, above);
  constexpr std::size_t within = 16, beside = 16;
  std::vector<Sensor> sensors = grid_on_floor(1.6, 4);
  for (Sensor& sensor : sensors) sensor.position.z = 0.7;
  for (std::size_t i = 0; i < beside; ++i) {
    const double along = -0.9 + 0.12 * static_cast<double>(i);
    sensors.push_back({{1.2 + thickness, along, 0}, {0, 0, 1}});
  }
  const std::vector<double> lux =
      lux_of(gather(scene, sensors, {.rays = 256}, one_device(), parameters_of(mode, rays)));
  double inside = 0, yard = 0;
  for (std::size_t i = 0; i < within; ++i) inside += lux[i] / within;
  for (std::size_t i = within; i < lux.size(); ++i) yard += lux[i] / beside;
  CAPTURE(inside, yard);
  CHECK(inside < 1e-4 * yard);
}

TEST_CASE("No light comes through a thin shell whose other side is lit") {
  const float gap = GENERATE(1e-5f, 1e-4f, 1e-3f, 1e-2f);
  const bool panel_above = GENERATE(true, false);
  const auto mode = GENERATE(LightMapMode::automatic, LightMapMode::on);
  CAPTURE(gap, panel_above, name_of(mode));
  const Scene scene = room_in_a_shell(gap, panel_above);
  const std::vector<Sensor> sensors{
      {{2, 2, 0.75}, {0, 0, 1}}, {{1, 1, 0.75}, {0, 0, 1}}, {{2, 2, 2.9}, {0, 0, 1}}};
  RenderParameters parameters = parameters_of(mode);
  parameters.photons.emitted_photons = GENERATE(20'000, 100'000);
  const std::vector<double> lux =
      lux_of(gather(scene, sensors, {.rays = 1024}, one_device(), parameters));
  // In the room the light would be some 0.1 lux.
  for (const double value : lux) CHECK(value < 1e-4);
}

TEST_CASE("A grid on a floor under a lamp reads its closed form between nodes") {
  Scene scene = plate(diffuse(glm::vec3(0.5f)), 4, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1}));
  const std::vector<Sensor> sensors = grid_on_floor(2.4, 24);
  std::vector<double> truth;
  for (const Sensor& sensor : sensors) {
    const double squared = glm::dot(sensor.position, sensor.position) + 1;
    truth.push_back(1 / (4 * glm::pi<double>() * std::pow(squared, 1.5)));
  }
  const RenderResult at_points =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::automatic));
  const RenderResult by_photons =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::on));
  const RenderResult by_rays =
      measure(scene, sensors, one_device(), parameters_of(LightMapMode::on, 16));
  CHECK(nodes_of(at_points) == 0);
  CHECK(nodes_of(by_photons) > 0);
  CHECK(nodes_of(by_rays) > 0);
  const double error = error_of(lux_of(by_photons), truth);
  CAPTURE(error, error_of(lux_of(at_points), truth));
  CHECK(error < 2.0 / 200);  // noise of k photons, and some bias
  CHECK(error <= 1.02 * error_of(lux_of(at_points), truth));
  CHECK(error_of(lux_of(by_rays), truth) <
        1e-4);  // a look at a lamp is exact; nodes lie 8 cm apart
}

TEST_CASE("Sensors in the air of a furnace read the same light everywhere, by rays to light maps") {
  constexpr double albedo = 0.5;
  const Scene box = furnace(diffuse(glm::vec3(albedo)));
  const double truth = 1.0 / 6 / (1 - albedo);  // 1 lm over 6 m2, and each bounce returns half
  std::vector<Sensor> sensors;
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)}) {
    sensors.push_back({{0.3, 0.6, 0.5}, normal});
    sensors.push_back({{0.9, 0.1, 0.2}, normal});
  }
  const RenderResult result =
      gather(box, sensors, {.rays = 1024}, one_device(), parameters_of(LightMapMode::on));
  CHECK(nodes_of(result) > 0);
  for (const double lux : lux_of(result)) CHECK(lux == Approx(truth).epsilon(0.02));
}

TEST_CASE("Sensors in a furnished room read what estimates at the ends of their rays give") {
  const Scene scene = furnished_room(2);
  std::vector<Sensor> sensors;
  for (int i = 0; i < 40; ++i) {
    sensors.push_back({{0.3 + 0.08 * i, 0.4 + 0.05 * i, 1.2}, {0, 0, 1}});
  }
  const auto mean_of = [&](LightMapMode mode, double& nodes) {
    const RenderResult result =
        gather(scene, sensors, {.rays = 256}, one_device(), parameters_of(mode));
    nodes = nodes_of(result);
    return lux_of(result);
  };
  double nodes = 0;
  const std::vector<double> at_ends = mean_of(LightMapMode::off, nodes);
  CHECK(nodes == 0);
  const std::vector<double> between_nodes = mean_of(LightMapMode::on, nodes);
  CHECK(nodes > 0);
  // Rays and photons are the same; what differs is the mean over 256 interpolations.
  CHECK(error_of(between_nodes, at_ends) < 0.01 * 0.01);
}

}  // namespace photile::test
