// Points in furniture are left out of grids.
#include <catch2/catch.hpp>

#include "measuring/floor.hpp"
#include "measuring/working_plane.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

/// A room of 4 x 6 m with a table, x from 1 to 2, whose top lies at 0.70 to 0.74 m; a solid
/// cupboard, x from 3 to 3.92, 2 m high, `inwards` if it is wound inside out; a single sheet under
/// the ceiling, z from 3 on.
Scene furnished(bool inwards) {
  test::SceneBuilder builder("room");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({1, 0.70f, 0.4f}, {2, 0.74f, 5.6f}, white, false);
  builder.box({3, 0.01f, 0.4f}, {3.92f, 2, 5.6f}, white, inwards);
  builder.quad({0.5f, 2.4f, 3}, {3.5f, 2.4f, 3}, {3.5f, 2.4f, 5.9f}, {0.5f, 2.4f, 5.9f}, white);
  builder.add(test::point_light("lamp", {2.5f, 2.2f, 3}));
  return builder.build();
}

SensorGrid plane_at(const Scene& scene, const char* height) {
  WorkingPlane plane = parse_working_plane(height);
  plane.spacing = 0.2;
  return working_plane_grid(scene, plane);
}

}  // namespace

TEST_CASE("points in a solid, or nearer to a surface than the clearance, are left out") {
  const Scene scene = furnished(GENERATE(false, true));
  SensorGrid grid = plane_at(scene, "floor+0.8");
  const std::vector<Sensor> all = grid.sensors;
  std::size_t expected = 0;
  const auto stays = [](const glm::dvec3& at) {
    const bool along = at.z > 0.4 && at.z < 5.6;
    return !(along && ((at.x > 1 && at.x < 2) || (at.x > 3 && at.x < 3.92)));
  };
  for (const Sensor& sensor : all) expected += stays(sensor.position) ? 0 : 1;
  REQUIRE(expected > 100);
  CHECK(leave_out_furniture(scene, 0.1, grid) == expected);
  for (const Sensor& sensor : grid.sensors) CHECK(stays(sensor.position));
  REQUIRE(grid.layout);
  REQUIRE(grid.layout->cells.size() == grid.sensors.size());
  for (std::size_t i = 0; i < grid.sensors.size(); ++i) {
    CHECK(glm::distance(grid.layout->middle_of(grid.layout->cells[i]), grid.sensors[i].position) <
          1e-9);
  }
}

TEST_CASE("a table that is farther away than the clearance leaves its points in") {
  const Scene scene = furnished(false);
  SensorGrid grid = plane_at(scene, "floor+0.8");
  const std::size_t all = grid.sensors.size();
  const std::size_t left_out = leave_out_furniture(scene, 0.03, grid);  // the cupboard alone
  std::size_t over_table = 0;
  for (const Sensor& sensor : grid.sensors) {
    const glm::dvec3& at = sensor.position;
    over_table += at.x > 1 && at.x < 2 && at.z > 0.4 && at.z < 5.6 ? 1 : 0;
  }
  CHECK(over_table > 50);
  CHECK(left_out > 50);
  CHECK(left_out + grid.sensors.size() == all);
}

}  // namespace photile::test
