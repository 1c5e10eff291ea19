// Surfaces to measure on.
#include "measuring/working_plane.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "measuring/furniture.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

// The grid of EN 12464-1: its spacing, and where a room's floor is.

WorkingPlane plane_of(const std::string& text, double wall_band) {
  WorkingPlane plane = parse_working_plane(text);
  plane.wall_band = wall_band;
  return plane;
}

/// A room of 4 x 6 m, 2.5 m high, whose floor slab is 0.2 m thick and carries a table; y is up.
Scene room_on_a_slab() {
  test::SceneBuilder builder("room");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box({0, -0.2f, 0}, {4, 0, 6}, white, false);
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({1, 0.7f, 1}, {3, 0.75f, 2}, white, false);
  builder.add(test::point_light("lamp", {2, 2, 3}));
  return builder.build();
}

TEST_CASE("a room has the size between its floor, its walls and its ceiling") {
  const auto room = room_size(room_on_a_slab(), glm::dvec3(0.5, 1, 5));
  REQUIRE(room);
  CHECK(room->height == Approx(2.5).epsilon(0.005));
  CHECK(room->floor == Approx(0).margin(0.005));
  CHECK(room->area == Approx(24).epsilon(0.005));
  CHECK(room->sides.x == Approx(4).epsilon(0.02));
  CHECK(room->sides.y == Approx(6).epsilon(0.02));
  CHECK_THROWS_AS(room_size(room_on_a_slab(), glm::dvec3(9, 1, 5)), UsageError);
}

/// An L: 4 x 4 m without the quarter x > 2, z > 2; y is up.
Scene room_like_an_l() {
  test::SceneBuilder builder("L");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 0}, {0, 0, 2}, {4, 0, 0}, 1, white);
  builder.grid({0, 0, 2}, {0, 0, 2}, {2, 0, 0}, 1, white);
  builder.add(test::point_light("lamp", {1, 2, 1}));
  return builder.build();
}

/// A room of 4 x 3 m, 2.4 m high, with its floor at 0.3 m: a window without glass looks out on a
/// street of 40 x 40 m at 0 m, which runs on below the room and has a roof over it. A doorway of
/// 2 m leads into a second room of 3 x 3 m with the same floor. y is up.
Scene room_in_a_street(bool lamp_at_camera = false) {
  test::SceneBuilder builder("street");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, 4, white);
  builder.grid({-20, 8, -20}, {40, 0, 0}, {0, 0, 40}, 4, white);
  builder.grid({0, 0.3f, 0}, {0, 0, 3}, {7, 0, 0}, 2, white);     // floor of both rooms
  builder.grid({0, 2.7f, 0}, {7, 0, 0}, {0, 0, 3}, 2, white);     // their ceiling
  builder.grid({0, 0.3f, 0}, {7, 0, 0}, {0, 2.4f, 0}, 2, white);  // walls along x
  builder.grid({0, 0.3f, 3}, {7, 0, 0}, {0, 0.9f, 0}, 2, white);  // below the window
  builder.grid({0, 2.3f, 3}, {7, 0, 0}, {0, 0.4f, 0}, 2, white);  // above it
  builder.grid({0, 0.3f, 0}, {0, 0, 3}, {0, 2.4f, 0}, 2, white);
  builder.grid({7, 0.3f, 0}, {0, 0, 3}, {0, 2.4f, 0}, 2, white);
  builder.grid({4, 0.3f, 0}, {0, 0, 2}, {0, 2.4f, 0}, 2, white);  // between the rooms
  builder.grid({4, 2.3f, 2}, {0, 0, 1}, {0, 0.4f, 0}, 2, white);  // above the doorway
  builder.box({1, 0.3f, 0}, {3, 1.0f, 1}, white, false);          // a table
  if (lamp_at_camera) builder.box({1.8f, 2, 1.4f}, {2.2f, 2.1f, 1.6f}, white, false);
  builder.add(test::point_light("lamp", {1, 2, 2}));
  Scene scene = builder.build();
  scene.cameras = {Camera::look_at({2, 1.8, 1.5}, {2, 1, 30}, {0, 1, 0}, 1)};
  return scene;
}

/// The sensors' lowest and highest coordinates.
std::pair<glm::dvec3, glm::dvec3> bounds_of(const SensorGrid& grid) {
  glm::dvec3 low(1e9), high(-1e9);
  for (const Sensor& sensor : grid.sensors) {
    low = glm::min(low, sensor.position);
    high = glm::max(high, sensor.position);
  }
  return {low, high};
}

TEST_CASE("the floor is that of the camera's room, not the street's or the next room's") {
  WorkingPlane plane = plane_of("floor+0.75", 0);
  plane.spacing = 0.25;
  const SensorGrid grid = working_plane_grid(room_in_a_street(GENERATE(false, true)), plane);
  REQUIRE(grid.layout);
  CHECK(grid.layout->columns == 16);
  CHECK(grid.layout->rows == 12);
  CHECK(grid.sensors.size() == 16 * 12);
  const auto [low, high] = bounds_of(grid);
  CHECK(low.y == Approx(1.05));
  CHECK(low.x == Approx(0.125).margin(1e-3));
  CHECK(high.x == Approx(3.875).margin(1e-3));
  CHECK(low.z == Approx(0.125).margin(1e-3));
  CHECK(high.z == Approx(2.875).margin(1e-3));
}

TEST_CASE("a point inside tells another room, and a camera outside the one that it looks into") {
  WorkingPlane plane = plane_of("floor+0.75", 0);
  plane.spacing = 0.25;
  Scene scene = room_in_a_street();
  scene.cameras[0] = Camera::look_at({5.5, 100, 1.5}, {5.5, 0, 1.5}, {0, 0, 1}, 1);
  plane.inside = glm::dvec3(5.5, 1.5, 1);
  const auto [low, high] = bounds_of(working_plane_grid(scene, plane));
  CHECK(low.x == Approx(4.125).margin(1e-3));
  CHECK(high.x == Approx(6.875).margin(1e-3));
  CHECK(low.y == Approx(1.05));

  plane.inside.reset();
  scene.cameras[0] = Camera::look_at({2, 1.8, -30}, {2, 1.8, 1.5}, {0, 1, 0}, 1);
  scene.origin = {10, 0, 0};
  const SensorGrid street = working_plane_grid(scene, plane);  // covered, up to its wall
  CHECK(bounds_of(street).first.y == Approx(0.75));
  plane.inside = glm::dvec3(15.5, 1.5, 1);  // in the file's world
  CHECK(bounds_of(working_plane_grid(scene, plane)).first.x == Approx(14.125).margin(1e-3));
}

/// Two rooms of 6 x 4 m under one gable roof, whose height is 3 m at x = 3 and 0 at x = 0 and 6,
/// with a door of 1 x 2 m between them at z = 4; y is up.
Scene attic() {
  test::SceneBuilder builder("attic");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 0}, {0, 0, 8}, {6, 0, 0}, 4, white);
  builder.grid({0, 0, 0}, {3, 3, 0}, {0, 0, 8}, 2, white);
  builder.grid({3, 3, 0}, {3, -3, 0}, {0, 0, 8}, 2, white);
  for (const float z : {0.0f, 8.0f}) builder.triangle({0, 0, z}, {6, 0, z}, {3, 3, z}, white);
  builder.triangle({0, 0, 4}, {2.5f, 0, 4}, {2.5f, 2.5f, 4}, white);
  builder.triangle({3.5f, 0, 4}, {6, 0, 4}, {3.5f, 2.5f, 4}, white);
  builder.quad({2.5f, 2, 4}, {3.5f, 2, 4}, {3.5f, 2.5f, 4}, {2.5f, 2.5f, 4}, white);
  builder.triangle({2.5f, 2.5f, 4}, {3.5f, 2.5f, 4}, {3, 3, 4}, white);
  builder.add(test::point_light("lamp", {3, 2, 2}));
  return builder.build();
}

TEST_CASE("a plane in an attic reaches to where the slopes come down to it") {
  const auto [text, height] = GENERATE(
      table<const char*, double>({{"floor+0.75", 0.75}, {"floor+1.5", 1.5}, {"2.25", 2.25}}));
  WorkingPlane plane = plane_of(text, 0);
  plane.inside = glm::dvec3(3, 1.2, 2);
  plane.spacing = 0.25;
  SensorGrid grid = working_plane_grid(attic(), plane);
  REQUIRE(grid.layout);
  CHECK(leave_out_furniture(attic(), 0, grid, plane.inside) == 0);
  CHECK(grid.layout->origin.x == Approx(height).margin(0.005));
  CHECK(glm::length(grid.layout->u) == Approx(6 - 2 * height).margin(0.01));
  CHECK(glm::length(grid.layout->v) == Approx(4).margin(0.01));
  CHECK(double(grid.sensors.size()) == Approx((6 - 2 * height) * 4 * 16));
  const auto room = room_size(attic(), plane.inside);
  REQUIRE(room);
  CHECK(room->area == Approx(24).epsilon(0.01));
}

TEST_CASE("the number of points is that of EN 12464-1, table A.1") {
  const auto [side, points] =
      GENERATE(table<double, int>({{1, 5}, {2, 6}, {5, 8}, {10, 10}, {100, 20}}));
  CHECK(points_of_en12464(side, side).columns == points);
  CHECK(points_of_en12464(side, side).rows == points);
}

TEST_CASE("the other side has cells as nearly square as whole numbers allow") {
  const PointCounts nearly = points_of_en12464(5, 3);  // d = 5: 8 points, 0.625 m
  CHECK(nearly.columns == 8);
  CHECK(nearly.rows == 5);
  const PointCounts corridor = points_of_en12464(2, 20);  // d = 2, for 20 >= 2 x 2
  CHECK(corridor.columns == 6);
  CHECK(corridor.rows == 60);
}

TEST_CASE("a height is floor+METRES or metres in the world") {
  CHECK(parse_working_plane("floor+0.75").above_floor);
  CHECK(parse_working_plane("floor+0.75").height == 0.75);
  CHECK(parse_working_plane("floor").height == 0);
  CHECK_FALSE(parse_working_plane("1.2").above_floor);
  CHECK(parse_working_plane("-1.2").height == -1.2);
}

TEST_CASE("the floor is the room's, not the slab's underside, the table or the ceiling") {
  const SensorGrid grid = working_plane_grid(room_on_a_slab(), plane_of("floor+0.8", 0.5));
  REQUIRE(grid.layout);
  // 3 x 5 m within the band: d = 5 m, 8 points there, 0.625 m, so 5 points along 3 m.
  CHECK(grid.layout->columns == 5);
  CHECK(grid.layout->rows == 8);
  REQUIRE(grid.sensors.size() == 40);
  for (const Sensor& sensor : grid.sensors) CHECK(sensor.normal == glm::dvec3(0, 1, 0));
  const auto [low, high] = bounds_of(grid);
  CHECK(low.y == Approx(0.8));
  CHECK(high.y == Approx(0.8));
  CHECK(low.x == Approx(0.8));
  CHECK(high.x == Approx(3.2));
  CHECK(low.z == Approx(0.5 + 0.3125));
  CHECK(high.z == Approx(5.5 - 0.3125));
}

TEST_CASE("a plane at a height of the world counts from the file's origin") {
  Scene scene = room_on_a_slab();
  scene.origin = {100, 10, 0};
  const SensorGrid grid = working_plane_grid(scene, plane_of("11", 0.5));
  CHECK(grid.sensors.front().position.y == Approx(11));
  CHECK(grid.sensors.front().position.x > 100);
  CHECK(working_plane_grid(scene, plane_of("floor+1", 0.5)).sensors.front().position.y ==
        Approx(11));
}

TEST_CASE("points beyond the floor's border, or in the band along it, are left out") {
  WorkingPlane plane = plane_of("floor+0.75", 0.25);
  plane.spacing = 0.25;
  const SensorGrid grid = working_plane_grid(room_like_an_l(), plane);
  REQUIRE(grid.layout);
  CHECK(grid.layout->columns == 14);
  CHECK(grid.layout->rows == 14);
  // 14 x 14 cells of 0.25 m reach from 0.25 to 3.75 m; those at 1.875 or more in both are gone.
  for (const Sensor& sensor : grid.sensors) {
    CHECK_FALSE((sensor.position.x > 1.75 && sensor.position.z > 1.75));
  }
  CHECK(grid.sensors.size() == 14 * 14 - 8 * 8);
}

TEST_CASE("a floor of three corners ends at each of its sides, whichever comes first") {
  const std::array<glm::vec3, 3> corners{glm::vec3(0, 0, 0), glm::vec3(0, 0, 4),
                                         glm::vec3(4, 0, 0)};
  for (std::size_t first = 0; first < 3; ++first) {
    CAPTURE(first);
    test::SceneBuilder builder("triangle");
    builder.triangle(corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3],
                     builder.add(test::diffuse(glm::vec3(0.5f))));
    builder.add(test::point_light("lamp", {1, 2, 1}));
    WorkingPlane plane = plane_of("floor+0.75", 0);
    plane.spacing = 0.25;
    const SensorGrid grid = working_plane_grid(builder.build(), plane);
    for (const Sensor& sensor : grid.sensors) {
      CHECK(sensor.position.x + sensor.position.z < 4.02);
    }
    // Of 16 x 16 cells the half, and those on the border.
    CHECK(grid.sensors.size() == 8 * 17);
  }
}

// Grids on walls, ceilings, cylinders and around tasks.

/// A room of 4 x 2.5 x 6 m (y is up) with a pane of glass in a part of the wall at x = 4.
Scene glazed_room(bool window = false) {
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

TEST_CASE("each wall has a grid that faces into the room, and so has the ceiling") {
  const Scene scene = glazed_room();
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

TEST_CASE("a spacing of too many points is refused on the floor and on walls") {
  WorkingPlane fine = at_middle("floor");
  fine.spacing = 1e-4;
  CHECK_THROWS_WITH(working_plane_grid(glazed_room(), fine), Catch::Contains("1000000 points"));
  CHECK_THROWS_WITH(wall_grids(glazed_room(), fine), Catch::Contains("1000000 points"));
}

TEST_CASE("points of a wall that are glass are blank") {
  const auto walls = wall_grids(glazed_room(true), at_middle("floor"));
  const auto right = std::find_if(walls.begin(), walls.end(),
                                  [](const SensorGrid& grid) { return grid.name == "east wall"; });
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
  CHECK(working_plane_grid(glazed_room(), at_middle("floor")).remark.empty());
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

TEST_CASE("the background is a band around the surroundings as far as the room reaches") {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.json";
  std::ofstream(file) << R"({"name": "desk", "origin": [1, 0.8, 2], "u": [2, 0, 0],
      "v": [0, 0, -1], "surroundings": 0.5, "background": 3})";
  auto grids = read_planes(file);
  REQUIRE(grids.size() == 3);
  SensorGrid& background = grids[2];
  CHECK(background.name == "desk background");
  CHECK(background.role == GridRole::background);
  // 9 x 8 m: 0.2 x 5^log10(9) = 0.93 m, of which ten go into 9 m.
  CHECK(background.layout->columns == 10);
  keep_in_room(room_on_a_slab(), {2, 0.9, 1.5}, background);
  CHECK(background.role == GridRole::background);
  REQUIRE_FALSE(background.sensors.empty());
  bool far = false;
  for (const Sensor& sensor : background.sensors) {
    const glm::dvec3& p = sensor.position;
    CHECK((p.x > 0 && p.x < 4 && p.z > 0 && p.z < 6));
    CHECK_FALSE((p.x > 0.5 && p.x < 3.5 && p.z > 0.5 && p.z < 2.5));
    far = far || p.z > 4;
  }
  CHECK(far);
  const double area = glm::length(background.layout->u) * glm::length(background.layout->v);
  CHECK(area < 30);  // the room's 24 m2, rounded up to cells
  SensorGrid open = grids[2];
  const std::size_t all = open.sensors.size();
  keep_in_room(room_like_an_l(), {1, 0.9, 1}, open);  // which has no ceiling
  CHECK(open.sensors.size() == all);
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
    CHECK((behind > 10) == (grid.name == "east wall"));
    SensorGrid near = grid;
    CHECK(leave_out_furniture(scene, 0.4, near) == 0);
    CHECK(leave_out_furniture(scene, 0.6, grid) >= behind);
    for (const Sensor& sensor : grid.sensors) {
      const glm::dvec3& p = sensor.position;
      CHECK_FALSE((p.x > 3.9 && p.y < 2 && p.z > 1 && p.z < 3));
    }
  }
}

}  // namespace
}  // namespace photile::test
