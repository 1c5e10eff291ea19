// Surfaces to measure on.
#include "measuring/working_plane.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

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
  CHECK(glm::distance(low, glm::dvec3(0.125, 1.05, 0.125)) < 1e-3);
  CHECK(glm::distance(high, glm::dvec3(3.875, 1.05, 2.875)) < 1e-3);
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
  CHECK(leave_out_furniture(attic(), 0, grid) == 0);
  CHECK(grid.layout->origin.x == Approx(height).margin(0.005));
  CHECK(glm::length(grid.layout->u) == Approx(6 - 2 * height).margin(0.01));
  CHECK(glm::length(grid.layout->v) == Approx(4).margin(0.01));
  CHECK(double(grid.sensors.size()) == Approx((6 - 2 * height) * 4 * 16));
  const auto room = room_at(attic(), plane.inside);
  REQUIRE(room);
  CHECK(room->facts["area"].get<double>() == Approx(24).epsilon(0.01));
}

/// Walls on the corners of a plan, with a floor and a ceiling 2.5 m apart; x and z, around a point.
void add_room(test::SceneBuilder& builder, std::uint32_t white, const glm::vec3& middle,
              const std::vector<glm::dvec2>& corners) {
  const glm::vec3 up(0, 2.5f, 0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec3 a(corners[i].x, 0, corners[i].y);
    const glm::dvec2& next = corners[(i + 1) % corners.size()];
    const glm::vec3 b(next.x, 0, next.y);
    builder.quad(a, b, b + up, a + up, white);
    builder.triangle(a, middle, b, white);
    builder.triangle(a + up, b + up, middle + up, white);
  }
}

TEST_CASE("rooms are found with the corners of their plans, and have grids by their names") {
  const std::vector<glm::dvec2> l{{0, 0}, {6, 0}, {6, 2}, {4, 2}, {4, 4}, {0, 4}};
  const std::vector<glm::dvec2> slanted{{0, 6}, {4, 6}, {2, 9}, {0, 9}};
  test::SceneBuilder builder("rooms");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  add_room(builder, white, {3, 0, 1.5f}, l);
  add_room(builder, white, {1, 0, 7.5f}, slanted);
  builder.box({1.8f, 0, 2.6f}, {2.2f, 2.5f, 3}, white, false);  // a column in the L
  builder.add(test::point_light("lamp", {1, 2, 1}));
  Scene scene = builder.build();
  scene.origin = {10, 1, 0};
  const std::vector<NamedRoom> rooms = rooms_of(scene);
  REQUIRE(rooms.size() == 2);
  const auto has_corners = [&](const nlohmann::json& ring, const std::vector<glm::dvec2>& corners) {
    CHECK(ring.size() == corners.size());
    for (const glm::dvec2& corner : corners) {
      const glm::dvec3 there(corner.x + 10, 1, corner.y);
      CHECK(std::any_of(ring.begin(), ring.end(), [&](const nlohmann::json& p) {
        return glm::distance(glm::dvec3(p[0], p[1], p[2]), there) < 0.005;
      }));
    }
  };
  for (const NamedRoom& room : rooms) {
    const nlohmann::json& facts = room.facts;
    const bool is_l = facts["area"] > 15;
    CHECK(facts["area"].get<double>() == Approx(is_l ? 20 - 0.16 : 9).epsilon(1e-3));
    CHECK(facts["height"].get<double>() == Approx(2.5).epsilon(0.005));
    CHECK(facts["floor"].get<double>() == Approx(1).margin(0.005));
    has_corners(facts["outline"], is_l ? l : slanted);
    REQUIRE(facts["holes"].size() == (is_l ? 1u : 0u));
    if (is_l) has_corners(facts["holes"][0], {{1.8, 2.6}, {2.2, 2.6}, {2.2, 3}, {1.8, 3}});
  }

  const auto grids = grids_at(
      scene, {.plane = "floor+0.75", .ceiling = true, .rooms = rooms_named(scene, "room *")},
      Progress::none());
  REQUIRE(grids.size() == 4);
  CHECK((grids[0].name == "room 1" && grids[3].name == "room 2: ceiling"));
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK((bounds_of(grids[i]).second.z < 5) == (rooms[i / 2].facts["area"] > 15));
  }
  CHECK_THROWS_WITH(rooms_named(scene, "hall"), Catch::Contains("room 1, room 2"));
  CHECK_THROWS_AS(room_at(scene, glm::dvec3(9, 1, 5)), UsageError);
}

TEST_CASE("the number of points is that of EN 12464-1, table A.1") {
  const auto [side, points] =
      GENERATE(table<double, int>({{1, 5}, {2, 6}, {5, 8}, {10, 10}, {100, 20}}));
  CHECK(points_of_en12464(side, side).columns == points);
  CHECK(points_of_en12464(side, side).rows == points);
  // The other side has cells as nearly square as whole numbers allow.
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
  CHECK(glm::distance(low, glm::dvec3(0.8, 0.8, 0.5 + 0.3125)) < 1e-5);
  CHECK(glm::distance(high, glm::dvec3(3.2, 0.8, 5.5 - 0.3125)) < 1e-5);
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

/// A room of 4 x 2.5 x 6 m (y is up) of the material 0.
SceneBuilder bare_room() {
  SceneBuilder builder("room");
  builder.box({0, 0, 0}, {4, 2.5f, 6}, builder.add(diffuse(glm::vec3(0.5f))), true);
  builder.add(point_light("lamp", {2, 2.2f, 3}));
  return builder;
}

/// The same with a pane of glass in a part of the wall at x = 4.
Scene glazed_room(bool window = false) {
  SceneBuilder builder = bare_room();
  if (window) {
    const auto pane = builder.add(glass(1.5f, true));
    builder.quad({3.99f, 0, 0}, {3.99f, 0, 3}, {3.99f, 2.5f, 3}, {3.99f, 2.5f, 0}, pane);
  }
  return builder.build();
}

WorkingPlane at_middle(const char* height) {
  WorkingPlane plane = parse_working_plane(height);
  plane.inside = glm::dvec3(2, 1.2, 3);
  return plane;
}

TEST_CASE("each wall has a grid that faces into the room, and so has the ceiling, of few points") {
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

TEST_CASE("surroundings are a band around a task, the background one as far as the room reaches") {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.json";
  std::ofstream(file) << R"({"name": "desk", "origin": [1, 0.8, 2], "u": [2, 0, 0],
      "v": [0, 0, -1], "surroundings": 0.5, "background": 3})";
  auto grids = read_planes(file);
  REQUIRE(grids.size() == 3);
  CHECK(grids[1].name == "desk surroundings");
  CHECK(grids[1].role == GridRole::surroundings);
  for (const Sensor& sensor : grids[1].sensors) {
    const glm::dvec3& p = sensor.position;
    CHECK_FALSE((p.x > 1 && p.x < 3 && p.z > 1 && p.z < 2));
    CHECK((p.x > 0.5 && p.x < 3.5 && p.z > 0.5 && p.z < 2.5));
  }
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
  SceneBuilder builder = bare_room();
  builder.box({3, 0.01f, 0.4f}, {3.92f, 2, 5.6f}, 0, false);
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
  SceneBuilder builder = bare_room();
  builder.grid({3.5f, 0, 1}, {0, 2, 0}, {0, 0, 2}, 1, 0);  // a screen before the wall at x = 4
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
