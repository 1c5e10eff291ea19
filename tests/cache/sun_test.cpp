// The border of a sun's light at points that gather, in closed form.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "gathering.hpp"
#include "photile/scene.hpp"
#include "suns.hpp"
#include "trace/bright_surface.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/light_sampler.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

constexpr double sun_diameter = 0.0093, sun_lux = 40'000;

Light overhead_sun() { return sun_along({0, 0, -1}, static_cast<float>(sun_diameter)); }

/// A black floor in z = 0 under a sky and a sun overhead, and a plate 1 m above that leaves y > 0.
Scene floor_half_in_shadow() {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, black);
  builder.grid({-1, -1, 1}, {2, 0, 0}, {0, 1, 0}, 1, black);
  builder.add_distant(overhead_sun(), sun_lux);
  builder.add_surroundings("sky", EnvironmentMap("sky", 1, 1, {glm::vec3(100.0f)}));
  return builder.build();
}

/// The part of the disc of the sun that is seen from the floor at this y.
double seen_of_sun(double y) {
  const double t = std::clamp(-y / std::tan(sun_diameter / 2), -1.0, 1.0);
  return (std::acos(t) - t * std::sqrt(1 - t * t)) / pi;
}

}  // namespace

TEST_CASE("gathering: the border of a sun's light is its closed form without noise") {
  GatheringScene place(floor_half_in_shadow(), looked_up(50'000));
  const std::vector<double> powers = light::layer_powers(place.scene);
  std::vector<Sensor> sensors;
  for (int i = -20; i <= 20; ++i) sensors.push_back({{0.1, 0.0005 * i, 0}, {0, 0, 1}});
  const cache::GatheredParts light = place.gather({}).gather(
      trace::sensor_hits(place.rays, sensors), numbers(sensors.size()), 64, 128);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::size_t of_sun = 2 * i;
    const double seen = seen_of_sun(sensors[i].position.y);
    const double found = powers[0] * luminance(glm::dvec3(light.direct.irradiance[of_sun]));
    CAPTURE(sensors[i].position.y, seen);
    // To two of the samples that the edge parts.
    CHECK(
        found ==
        Approx(sun_lux * seen).epsilon(1e-4).margin(2.0 / defaults::hidden_sun_samples * sun_lux));
    if (seen == 0) CHECK(found == 0);
    CHECK(light.direct.error(of_sun) <= 1e-6 * found);
  }
}

TEST_CASE("gathering: rays leave a sun to its samples") {
  const Scene scene = floor_half_in_shadow();
  const trace::LightSampler sampler(scene);
  REQUIRE(sampler.sampled_apart() == std::vector<std::uint32_t>{0});
  const glm::vec3 point(0, 0.5f, 0), up(0, 0, 1);
  trace::SelectionProbabilities but_apart;
  sampler.weigh(point, up, but_apart);
  for (const trace::DistantLight& light : sampler.distant()) {
    CHECK(std::isinf(sampler.density(light, point, up, but_apart)) == (light.light() == 0));
    CHECK(std::isfinite(sampler.density(light, point, up)));
  }
}

TEST_CASE("gathering: lamps of many are chosen by chance, a sun among them, and count once") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, black);
  builder.add_distant(overhead_sun(), sun_lux);
  for (std::size_t i = 0; i < trace::LightClusters::most_lights; ++i) {
    const auto x = static_cast<float>(i) / trace::LightClusters::most_lights;
    builder.grid({x, 0.9f, 1}, {0, 1e-3f, 0}, {1e-4f, 0, 0}, 1, black,
                 builder.add(area_light("lamp " + std::to_string(i), 1e-6)));
  }
  GatheringScene place(builder.build(), looked_up(50'000));
  CHECK(trace::LightSampler(place.scene).sampled_apart().empty());
  const std::vector<double> powers = light::layer_powers(place.scene);
  const LightTable light = place.at({{{0.1, 0.2, 0}, {0, 0, 1}}});
  const LightTable::Total total = light.total(0, powers);
  CHECK(total.luminance == Approx(sun_lux).margin(5 * total.error + 1e-3 * sun_lux));
  CHECK(total.error < 0.1 * sun_lux);
}

// Rays that are aimed at bright surface find the same light with less noise.

TEST_CASE("gathering: rays are aimed at a bright plate, and find its light in closed form") {
  // A white plate of 0.6 m below the ceiling of a black box of 4 m, which another lamp fills with
  // photons: all that is reflected comes from the plate. A spot lights it from 2 m below.
  constexpr float side = 0.6f;
  constexpr double height = 3.999, albedo = 0.8;
  SceneBuilder builder;
  builder.box({-2, -2, 0}, {2, 2, 4}, builder.add(diffuse(0.0f)), true, 2);
  builder.grid({-side / 2, -side / 2, height}, {0, side, 0}, {side, 0, 0}, 1,
               builder.add(diffuse(albedo)));
  const Light spot = spot_light("spot", {0.1f, 0.0f, 1.9f}, {0, 0, 1}, 0.3f, 0.35f);
  builder.add(spot);
  builder.add(point_light("lamp", {0, 0, 1}));
  const double candela = 1 / (2 * pi * trace::SpotFalloff(spot).integral());
  GatheringScene room(builder.build(), looked_up(400'000));
  const std::vector<double> powers = light::layer_powers(room.scene);
  REQUIRE_FALSE(trace::bright_surface(room.rays, powers, 1).empty());

  const std::vector<Sensor> sensors =
      sensors_on({-1.9, -1.9, 0}, {3.8, 0, 0}, {0, 3.8, 0}, {0, 0, 1}, 12);
  const LightTable light =
      room.gather({})
          .gather(trace::sensor_hits(room.rays, sensors), numbers(sensors.size()), 144, 96)
          .indirect;
  double relative = 0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    double truth = 0;
    constexpr int cells = 64;
    for (int cell = 0; cell < cells * cells; ++cell) {
      const glm::dvec3 at((cell % cells + 0.5) / cells * side - side / 2,
                          (cell / cells + 0.5) / cells * side - side / 2, height);
      const double from_spot = glm::length(at - glm::dvec3(spot.position));
      const double to_sensor = glm::length(at - sensors[i].position);
      const double lit = candela * (height - spot.position.z) / std::pow(from_spot, 3);
      truth += lit * albedo / pi * std::pow(height, 2) / std::pow(to_sensor, 4) *
               std::pow(side / cells, 2);
    }
    const double found = luminance(glm::dvec3(light.irradiance[2 * i]));
    CAPTURE(i, found, truth);
    CHECK(found == Approx(truth).epsilon(0.02).margin(5 * light.error(2 * i)));
    // By the cosine alone few of the rays would meet the plate: 40% of noise.
    CHECK(light.error(2 * i) < 0.15 * truth);
    relative += (found / truth - 1) / static_cast<double>(sensors.size());
  }
  CHECK(std::abs(relative) < 0.02);
  CHECK(trace::bright_surface(RayScene(furnished_room()), std::vector<double>{1, 1}, 1).empty());
}

}  // namespace photile::test
