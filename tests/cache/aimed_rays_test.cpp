// Rays that are aimed at bright surface find the same light with less noise, in closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gathering.hpp"
#include "photile/scene.hpp"
#include "test_scenes.hpp"
#include "trace/bright_surface.hpp"
#include "trace/emission_sampling.hpp"

namespace photile::test {

using std::numbers::pi;

TEST_CASE("gathering: rays are aimed at a bright plate, and find its light in closed form") {
  // A white plate of 0.6 m below the ceiling of a black box of 4 m, which another lamp fills with
  // photons: all that is reflected comes from the plate. A spot lights it from 2 m below.
  constexpr float side = 0.6f;
  constexpr double height = 3.999, albedo = 0.8;
  SceneBuilder builder;
  builder.box({-2, -2, 0}, {2, 2, 4}, builder.add(diffuse(glm::vec3(0.0f))), true, 2);
  builder.grid({-side / 2, -side / 2, height}, {0, side, 0}, {side, 0, 0}, 1,
               builder.add(diffuse(glm::vec3(albedo))));
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
