// Grids on walls, ceilings, cylinders and around tasks.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "measuring/floor.hpp"
#include "measuring/sensor_grid.hpp"
#include "measuring/working_plane.hpp"
#include "photile/errors.hpp"
#include "statistical_tests.hpp"
#include "temporary_folder.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

/// A room of 4 x 2.5 x 6 m (y is up) with a pane of glass in a part of the wall at x = 4.
Scene room(bool window = false) {
  SceneBuilder builder("room");
  const auto white = builder.add(diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  if (window) {
    const auto pane = builder.add(glass(1.5f, true));
    builder.quad({3.99f, 0, 0}, {3.99f, 0, 3}, {3.99f, 2.5f, 3}, {3.99f, 2.5f, 0}, pane);
  }
  builder.add(point_light("lamp", {2, 2.2f, 3}));
  return builder.build();
}

WorkingPlane at_middle(const char* height) {
  WorkingPlane plane = parse_working_plane(height);
  plane.inside = glm::dvec3(2, 1.2, 3);
  return plane;
}

}  // namespace

TEST_CASE("each wall has a grid that faces into the room, and so has the ceiling") {
  const Scene scene = room();
  const auto walls = wall_grids(scene, at_middle("floor"));
  REQUIRE(walls.size() == 4);
  const glm::dvec3 inwards[]{{0, 0, 1}, {-1, 0, 0}, {0, 0, -1}, {1, 0, 0}};
  const double widths[]{4, 6, 4, 6};
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(walls[i].name);
    REQUIRE(walls[i].layout);
    CHECK(walls[i].blanks.empty());
    CHECK(walls[i].role == GridRole::wall);
    CHECK(glm::length(walls[i].layout->u) == Approx(widths[i]).epsilon(1e-3));
    CHECK(glm::length(walls[i].layout->v) == Approx(2.5).epsilon(1e-3));
    for (const Sensor& sensor : walls[i].sensors) {
      CHECK(glm::distance(sensor.normal, inwards[i]) < 1e-6);
      const glm::dvec3& p = sensor.position;
      const double to_wall = std::min(std::min(p.x, 4 - p.x), std::min(p.z, 6 - p.z));
      CHECK(to_wall == Approx(0.001).margin(1e-4));
    }
  }
  const SensorGrid ceiling = ceiling_grid(scene, at_middle("floor"));
  CHECK(ceiling.role == GridRole::ceiling);
  REQUIRE(ceiling.sensors.size() > 20);
  for (const Sensor& sensor : ceiling.sensors) {
    CHECK(sensor.position.y == Approx(2.499).margin(1e-4));
    CHECK(glm::distance(sensor.normal, glm::dvec3(0, -1, 0)) < 1e-6);
  }
}

TEST_CASE("points of a wall that are glass are blank") {
  const auto walls = wall_grids(room(true), at_middle("floor"));
  const auto right = std::find_if(walls.begin(), walls.end(), [](const SensorGrid& grid) {
    return grid.name == "wall at 90 degrees";
  });
  REQUIRE(right != walls.end());
  CHECK_FALSE(right->sensors.empty());
  for (const BlankPoint& blank : right->blanks) CHECK(blank.sensor.position.z < 3.1);
  CHECK(right->blanks.front().reason == "glass");
  for (const Sensor& sensor : right->sensors) CHECK(sensor.position.z > 3);
}

TEST_CASE("without a room there are no walls, and the plane says that it follows another floor") {
  SceneBuilder builder("plate");
  builder.grid({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 1, builder.add(diffuse(glm::vec3(0.5f))));
  builder.add(point_light("lamp", {0, 2, 0}));
  const Scene scene = builder.build();
  CHECK_THROWS_WITH(wall_grids(scene, {}), Catch::Contains("--inside"));
  CHECK_THAT(working_plane_grid(scene, {}).remark, Catch::Contains("--inside"));
  CHECK(working_plane_grid(room(), at_middle("floor")).remark.empty());
}

TEST_CASE(
    "semi-cylindrical illuminance of a point light is I (1 + cos alpha) sin / (glm::pi<double>() "
    "d^2)") {
  SceneBuilder builder("dark");
  builder.grid({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, 1, builder.add(diffuse(glm::vec3(0))));
  const glm::dvec3 lamp(1.5, 0.5, 2.0);
  builder.add(point_light("lamp", glm::vec3(lamp)));
  const Scene scene = builder.build();
  const glm::dvec3 eye(0, 0, 1.2);
  const glm::dvec3 way = lamp - eye;
  const double d2 = glm::dot(way, way), sine = std::hypot(way.x, way.y) / std::sqrt(d2);
  for (const double turn : {0.0, 0.7, 2.0, 3.1}) {
    Sensor sensor{eye, {0, 0, 1}};
    sensor.response = SensorResponse::semi_cylindrical;
    sensor.facing = {std::cos(turn), std::sin(turn), 0};
    const double alpha = turn - std::atan2(way.y, way.x);
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = 4}, 1).layers.dense();
    CHECK(double{layers.layers[0].illuminance[0]} ==
          Approx((1 + std::cos(alpha)) * sine / (glm::pi<double>() * 4 * glm::pi<double>() * d2))
              .epsilon(1e-4));
  }
}

TEST_CASE(
    "under an even sky half a cylinder reads glm::pi<double>() L, and of one side what lies before "
    "it") {
  Scene scene = plate(diffuse(glm::vec3(0)), 0.01f);
  const bool half = GENERATE(false, true);
  // A sky that shines from the half x > 0 alone: the integral of (1 + cos alpha) over it is
  // pi + 2 of 2 pi.
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 8; ++i) {
    const EnvironmentMap probe("probe", 8, 1, std::vector<glm::vec3>(8, glm::vec3(1.0f)));
    const bool lit = !half || probe.direction_at(i + 0.5, 0, 0.5).x > 0;
    texels.emplace_back(lit ? 2.0f : 0.0f);
  }
  add_environment(scene, EnvironmentMap("sky", 8, 1, texels));
  Sensor sensor{{0, 0.5, 0}, {0, 1, 0}};
  sensor.response = SensorResponse::semi_cylindrical;
  sensor.facing = {1, 0, 0};
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = 4096}, seed).layers.dense();
    values.push_back(scene.lights[0].power * double{layers.layers[0].illuminance[0]});
  }
  const double truth =
      glm::pi<double>() * 2 * (half ? (glm::pi<double>() + 2) / (2 * glm::pi<double>()) : 1);
  CHECK_VERDICT(mean_is(values, truth, 0.03 * truth));
}

TEST_CASE("a task has a band of surroundings around it") {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.json";
  std::ofstream(file)
      << R"({"name": "desk", "origin": [1, 0.75, 1], "u": [0, 0, 1], "v": [1.6, 0, 0],
                             "spacing": 0.2, "surroundings": 0.5})";
  const auto grids = read_planes(file);
  REQUIRE(grids.size() == 2);
  CHECK(grids[1].name == "desk surroundings");
  CHECK(grids[1].role == GridRole::surroundings);
  CHECK(grids[1].sensors.size() > grids[0].sensors.size());
  for (const Sensor& sensor : grids[1].sensors) {
    const glm::dvec3& p = sensor.position;
    CHECK_FALSE((p.x > 1 && p.x < 2.6 && p.z > 1 && p.z < 2));
    CHECK((p.x > 0.5 && p.x < 3.1 && p.z > 0.5 && p.z < 2.5));
    CHECK(p.y == Approx(0.75));
  }
}

TEST_CASE("a band of more cells than memory holds is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.json";
  for (const char* band : {"1e-9", "1e-4", "1000", "1e9"}) {
    std::ofstream(file) << R"({"origin": [1, 0.75, 1], "u": [0, 0, 1], "v": [1.6, 0, 0],
                              "columns": 9, "rows": 9, "surroundings": )"
                        << band << "}";
    CAPTURE(band);
    CHECK_THROWS_WITH(read_planes(file), Catch::Contains("surroundings"));
  }
}

TEST_CASE("points in a solid are blank with a reason and their place in the grid") {
  SceneBuilder builder("room");
  const auto white = builder.add(diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({3, 0.01f, 0.4f}, {3.92f, 2, 5.6f}, white, false);
  builder.add(point_light("lamp", {2, 2.2f, 3}));
  const Scene scene = builder.build();
  SensorGrid grid{"points", {}, {}};
  for (const double x : {0.5, 3.5, 1.5, 2.0, 4.5}) grid.sensors.push_back({{x, 1, 3.1}, {0, 1, 0}});
  CHECK(leave_out_furniture(scene, 0, grid) == 2);
  REQUIRE(grid.blanks.size() == 2);
  CHECK(grid.blanks[0].sensor.position.x == 3.5);
  CHECK(grid.blanks[0].before == 1);
  CHECK(grid.blanks[1].sensor.position.x == 4.5);  // beyond the wall
  CHECK(grid.blanks[1].before == 3);
  CHECK_THAT(grid.blanks[0].reason, Catch::Contains("solid"));
  CHECK(grid.sensors.size() == 3);
}

TEST_CASE("a clearance looks before a wall, not into it") {
  SceneBuilder builder("room");
  const auto white = builder.add(diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.grid({3.5f, 0, 1}, {0, 2, 0}, {0, 0, 2}, 1, white);  // a screen before the wall at x = 4
  builder.add(point_light("lamp", {2, 2.2f, 3}));
  const Scene scene = builder.build();
  std::vector<SensorGrid> grids = wall_grids(scene, at_middle("floor"));
  REQUIRE(grids.size() == 4);
  for (SensorGrid& grid : grids) {
    CAPTURE(grid.name);
    std::size_t behind = 0;
    for (const Sensor& sensor : grid.sensors) {
      const glm::dvec3& p = sensor.position;
      behind += p.x > 3.9 && p.y < 2 && p.z > 1 && p.z < 3 ? 1 : 0;
    }
    CHECK((behind > 10) == (grid.name == "wall at 90 degrees"));
    SensorGrid near = grid;
    CHECK(leave_out_furniture(scene, 0.4, near) == 0);
    CHECK(leave_out_furniture(scene, 0.6, grid) >= behind);
    for (const Sensor& sensor : grid.sensors) {
      const glm::dvec3& p = sensor.position;
      CHECK_FALSE((p.x > 3.9 && p.y < 2 && p.z > 1 && p.z < 3));
    }
  }
}

}  // namespace photile::test
