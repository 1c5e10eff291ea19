// Walls, furniture and lamps on plans, of a room that is known.
#include "report/plan_surroundings.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "measuring/working_plane.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

/// A room of 4 x 6 m with a table, x from 1 to 2, z from 2 to 3, whose top lies at 0.7 m, and a
/// lamp over it.
Scene room() {
  test::SceneBuilder builder("room");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({1, 0.65f, 2}, {2, 0.70f, 3}, white, false);
  builder.add(test::point_light("lamp", {1.5f, 2.2f, 2.5f}));
  return builder.build();
}

/// A plane of 3 x 5 cells of a metre that begins at (0.5, 0.75, 5.5).
PlaneLayout layout() {
  PlaneLayout layout;
  layout.origin = {0.5, 0.75, 5.5};
  layout.u = {3, 0, 0};
  layout.v = {0, 0, -5};
  layout.columns = 3;
  layout.rows = 5;
  return layout;
}

/// x and z of a place in cells.
glm::dvec2 world(const glm::dvec2& cells) { return {0.5 + cells.x, 5.5 - cells.y}; }

double length_of(const std::vector<report::Segment>& segments) {
  double length = 0;
  for (const report::Segment& segment : segments) length += glm::distance(segment[0], segment[1]);
  return length;
}

}  // namespace

TEST_CASE("a plan's walls are where its plane cuts the room") {
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, layout());
  CHECK(around.reach >= 0.5);
  CHECK(length_of(around.walls) == Approx(20));  // 2 x (4 + 6) m
  for (const report::Segment& segment : around.walls) {
    for (const glm::dvec2& end : segment) {
      const glm::dvec2 at = world(end);
      const double from_wall =
          std::min({std::abs(at.x), std::abs(at.x - 4), std::abs(at.y), std::abs(at.y - 6)});
      CHECK(from_wall < 1e-5);
    }
  }
}

TEST_CASE("a plan's furniture is outlined where it stands, and its lamps have their numbers") {
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, layout());
  REQUIRE_FALSE(around.furniture.empty());
  glm::dvec2 low(100.0), high(-100.0);
  for (const report::Segment& segment : around.furniture) {
    for (const glm::dvec2& end : segment) {
      const glm::dvec2 at = world(end);
      if (at.x < 0.05 || at.x > 3.95 || at.y < 0.05 || at.y > 5.95) continue;  // walls
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  // Rays are 7 m / 300 apart.
  CHECK(glm::distance(low, glm::dvec2(1, 2)) < 0.04);
  CHECK(glm::distance(high, glm::dvec2(2, 3)) < 0.04);
  REQUIRE(around.lamps.size() == 1);
  CHECK(around.lamps[0].number == 1);
  CHECK(glm::distance(world(around.lamps[0].place), glm::dvec2(1.5, 2.5)) < 1e-6);
}

TEST_CASE("the JSON of a plan has its lines in metres from the plane's corner") {
  const Scene scene = room();
  const auto plan = report::plan_json(RayScene(scene), layout());
  CHECK(plan["reach"] == 1);
  // The room's outline is one line, of triangles that meet in it.
  const auto walls = plan["walls"].get<std::string>();
  CHECK(std::count(walls.begin(), walls.end(), 'M') == 1);
  CHECK(std::count(walls.begin(), walls.end(), 'L') <= 5);
  for (const char* const corner :
       {"-0.500 -0.500", "3.500 -0.500", "3.500 5.500", "-0.500 5.500"}) {
    CHECK_THAT(walls, Catch::Contains(corner));
  }
  CHECK(plan["lamps"][0]["number"] == 1);
  CHECK(plan["lamps"][0]["position"][0].get<double>() == Approx(1));
  CHECK(plan["lamps"][0]["position"][1].get<double>() == Approx(3));
  REQUIRE(plan["room"].size() == 2);
  CHECK(plan["room"][0][0].get<double>() == Approx(-0.5).margin(0.05));
  CHECK(plan["room"][1][1].get<double>() == Approx(5.5).margin(0.05));
}

TEST_CASE("the JSON of a plan has north and the outlines of luminaires") {
  Scene scene = room();
  scene.lights[0].direction = {0, -1, 0};
  scene.lights[0].x_axis = {0.8f, 0, -0.6f};  // (0.8, 0.6) on the plan
  scene.lights[0].distribution = 0;
  scene.distributions.emplace_back("a.ies", PhotometricAxes(), std::vector{0.0, 90.0},
                                   std::vector{0.0, 360.0}, std::vector<float>(4, 1.0f));
  scene.distributions[0].set_opening({.x = 1.2, .y = 0.3});
  const auto plan = report::plan_json(RayScene(scene), layout(), 90);
  REQUIRE(plan["lamps"][0]["outline"].size() == 4);
  for (const auto& corner : plan["lamps"][0]["outline"]) {
    const glm::dvec2 from(corner[0].get<double>() - 1, corner[1].get<double>() - 3);
    CHECK(std::abs(glm::dot(from, glm::dvec2(0.8, 0.6))) == Approx(0.6));
    CHECK(std::abs(glm::dot(from, glm::dvec2(-0.6, 0.8))) == Approx(0.15));
  }
  CHECK(plan["north"][0].get<double>() == Approx(1));
  CHECK(plan["north"][1].get<double>() == Approx(0).margin(1e-12));
  CHECK_FALSE(report::plan_json(RayScene(scene), layout()).contains("north"));
}

TEST_CASE("what does not lie flat has no surroundings") {
  PlaneLayout wall = layout();
  wall.v = {0, 1, 0};
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, wall);
  CHECK(around.reach == 0);
  CHECK(around.walls.empty());
}

}  // namespace photile::test
