// Points in furniture, on faces of partitions and in rooms within rooms are left out of grids.
#include "measuring/furniture.hpp"

#include <array>
#include <catch2/catch.hpp>

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

namespace {

/// The room of 4 x 2.5 x 6 m, and what a test puts into it.
struct FurnishedRoom {
  SceneBuilder builder{"room"};
  std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));

  FurnishedRoom() {
    builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
    builder.add(test::point_light("lamp", {2.5f, 2.2f, 3}));
  }

  /// The sides of a box without thickness that are asked for: x, y, z, below and above.
  void sheets(const glm::vec3& low, const glm::vec3& high,
              const std::array<std::array<bool, 2>, 3>& side) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool above : {false, true}) {
        if (!side[static_cast<std::size_t>(axis)][above ? 1 : 0]) continue;
        glm::vec3 corner = low, u(0.0f), v(0.0f);
        corner[axis] = above ? high[axis] : low[axis];
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        u[a] = high[a] - low[a];
        v[b] = high[b] - low[b];
        builder.grid(corner, u, v, 1, white);
      }
    }
  }
  /// The same of boards 2 cm thick, whose normals look out of each board, or into it.
  void boards(const glm::vec3& low, const glm::vec3& high,
              const std::array<std::array<bool, 2>, 3>& side, bool inwards = false) {
    constexpr float thick = 0.02f;
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool above : {false, true}) {
        if (!side[static_cast<std::size_t>(axis)][above ? 1 : 0]) continue;
        glm::vec3 from = low, to = high;
        (above ? from : to)[axis] = above ? high[axis] - thick : low[axis] + thick;
        builder.box(from, to, white, inwards);
      }
    }
  }
};

/// Points of the grid over the floor that stay, at 0.75 m and 0.2 m apart.
SensorGrid grid_of(const Scene& scene, const glm::dvec3& inside = {0.3, 2.0, 0.3}) {
  WorkingPlane plane = parse_working_plane("floor+0.75");
  plane.spacing = 0.2;
  plane.inside = inside;
  SensorGrid grid = working_plane_grid(scene, plane);
  leave_out_furniture(scene, 0, grid);
  return grid;
}

/// Whether exactly the points within a rectangle of the plan are left out.
void check_left_out(const SensorGrid& grid, const glm::dvec2& low, const glm::dvec2& high) {
  const auto within = [&](const Sensor& sensor) {
    const glm::dvec3& at = sensor.position;
    return at.x > low.x && at.x < high.x && at.z > low.y && at.z < high.y;
  };
  CHECK(grid.blanks.size() > 8);
  for (const Sensor& sensor : grid.sensors) {
    CAPTURE(sensor.position.x, sensor.position.z);
    CHECK_FALSE(within(sensor));
  }
  for (const BlankPoint& blank : grid.blanks) {
    CAPTURE(blank.sensor.position.x, blank.sensor.position.z, blank.reason);
    CHECK(within(blank.sensor));
  }
}

using Sides = std::array<std::array<bool, 2>, 3>;  // x, y, z; below and above
constexpr Sides closed{{{true, true}, {true, true}, {true, true}}};
constexpr Sides bottomless{{{true, true}, {false, true}, {true, true}}};
constexpr Sides tube{{{true, true}, {false, false}, {true, true}}};

}  // namespace

TEST_CASE("points in a hollow counter are left out, closed, without a bottom or with a gap") {
  FurnishedRoom room;
  const Sides sides = GENERATE(closed, bottomless);
  const float foot = GENERATE(0.0f, 0.1f);  // it stands on the floor, or on legs
  const bool boards = GENERATE(false, true), inwards = GENERATE(false, true);
  if (boards) {
    room.boards({1.55f, foot, 2.05f}, {2.35f, 0.9f, 4.45f}, sides, inwards);
  } else {
    room.sheets({1.55f, foot, 2.05f}, {2.35f, 0.9f, 4.45f}, sides);
  }
  CAPTURE(foot, boards, inwards);
  check_left_out(grid_of(room.builder.build()), {1.55, 2.05}, {2.35, 4.45});
}

TEST_CASE("a gap below the top of a counter lets no point in") {
  FurnishedRoom room;
  room.boards({1.55f, 0, 2.05f}, {2.35f, 0.85f, 4.45f}, tube);
  room.builder.box({1.5f, 0.88f, 2.0f}, {2.4f, 0.92f, 4.5f}, room.white, false);
  check_left_out(grid_of(room.builder.build()), {1.55, 2.05}, {2.35, 4.45});
}

TEST_CASE("a counter without a back that stands off the wall lets no point in") {
  FurnishedRoom room;
  room.boards({0.05f, 0, 2.05f}, {0.75f, 0.9f, 4.45f},
              {{{false, true}, {false, true}, {true, true}}});
  const SensorGrid grid = grid_of(room.builder.build());
  check_left_out(grid, {0.05, 2.05}, {0.75, 4.45});
}

TEST_CASE("a closed room within the room is left out, and a column that is open above and below") {
  FurnishedRoom room;
  room.boards({1.55f, 0, 2.05f}, {2.95f, 2.1f, 3.65f}, bottomless);
  check_left_out(grid_of(room.builder.build()), {1.55, 2.05}, {2.95, 3.65});
  FurnishedRoom with_column;
  with_column.sheets({1.55f, 0, 2.05f}, {2.55f, 2.5f, 3.05f}, tube);
  const SensorGrid grid = grid_of(with_column.builder.build());
  for (const Sensor& sensor : grid.sensors) {
    const glm::dvec3& at = sensor.position;
    CHECK_FALSE((at.x > 1.55 && at.x < 2.55 && at.z > 2.05 && at.z < 3.05));
  }
}

TEST_CASE("points in the closed room within a room stay where that is the room that is meant") {
  FurnishedRoom room;
  room.boards({1, 0, 1}, {3, 2.1f, 4}, bottomless);
  const SensorGrid grid = grid_of(room.builder.build(), {2, 1.5, 2});
  CHECK(grid.sensors.size() > 50);
  CHECK(grid.blanks.empty());
}

TEST_CASE("points below a wide table, a shelf and a gallery stay") {
  FurnishedRoom room;
  room.builder.box({0.5f, 1.1f, 0.5f}, {1.5f, 1.14f, 2.5f}, room.white, false);  // a table
  room.builder.box({2.4f, 0.2f, 4.0f}, {3.9f, 0.22f, 4.4f}, room.white, false);  // a shelf, open
  room.builder.box({2.4f, 1.2f, 4.0f}, {3.9f, 1.22f, 4.4f}, room.white, false);
  room.builder.box({0, 1.9f, 3.5f}, {2.2f, 2.0f, 6}, room.white, false);  // a gallery, 5.5 m2
  CHECK(grid_of(room.builder.build()).blanks.empty());
}

TEST_CASE("points inside a table's top are left out, points on and above it stay") {
  FurnishedRoom room;
  const float top = GENERATE(0.75f, 0.76f, 0.70f);
  room.builder.box({1.55f, top - 0.03f, 2.05f}, {2.35f, top, 4.45f}, room.white, false);
  const SensorGrid grid = grid_of(room.builder.build());
  CAPTURE(top);
  if (top == 0.76f) {
    check_left_out(grid, {1.55, 2.05}, {2.35, 4.45});
  } else {
    CHECK(grid.blanks.empty());
  }
}

TEST_CASE("points on the face of a partition are left out, of a sheet or of a board") {
  FurnishedRoom room;
  const float thick = GENERATE(0.0f, 0.08f);
  if (thick > 0) {
    room.builder.box({2.1f, 0, 1.05f}, {2.1f + thick, 1.6f, 5.05f}, room.white, false);
  } else {
    room.builder.grid({2.1f, 0, 1.05f}, {0, 1.6f, 0}, {0, 0, 4}, 1, room.white);
  }
  const SensorGrid grid = grid_of(room.builder.build());
  CHECK(grid.blanks.size() == 20);
  for (const BlankPoint& blank : grid.blanks) {
    CHECK(blank.sensor.position.x == Approx(2.1));
    CHECK(blank.reason == "less than 1 cm from a surface");
  }
}

TEST_CASE("points below closed stairs are left out, below open ones they stay") {
  const bool closed_sides = GENERATE(true, false);
  FurnishedRoom room;
  for (int step = 0; step < 8; ++step) {  // treads and risers
    const float z = 1.05f + 0.3f * static_cast<float>(step), y = 0.18f * static_cast<float>(step);
    room.builder.grid({1.05f, y, z}, {1, 0, 0}, {0, 0.18f, 0}, 1, room.white);
    room.builder.grid({1.05f, y + 0.18f, z}, {1, 0, 0}, {0, 0, 0.3f}, 1, room.white);
    if (!closed_sides) continue;
    for (const float x : {1.05f, 2.05f}) {
      room.builder.grid({x, 0, z}, {0, y + 0.18f, 0}, {0, 0, 0.3f}, 1, room.white);
    }
  }
  room.builder.grid({1.05f, 0, 3.45f}, {1, 0, 0}, {0, 1.44f, 0}, 1, room.white);
  const SensorGrid grid = grid_of(room.builder.build());
  CAPTURE(closed_sides);
  if (closed_sides) {
    check_left_out(grid, {1.05, 2.25}, {2.05, 3.45});
  } else {
    CHECK(grid.blanks.empty());
  }
}

TEST_CASE("points that the user gives stay where they lie in things, with a mark") {
  FurnishedRoom room;
  room.boards({1.55f, 0, 2.05f}, {2.35f, 0.9f, 4.45f}, closed);
  const Scene scene = room.builder.build();
  SensorGrid points{"points",
                    {{{0.5, 0.75, 0.5}, {0, 1, 0}},
                     {{2.0, 0.75, 3.0}, {0, 1, 0}},
                     {{3.5, 0.75, 0.5}, {0, 1, 0}},
                     {{2.355, 0.75, 3.0}, {0, 1, 0}}},
                    std::nullopt};
  CHECK(leave_out_furniture(scene, 0, points) == 0);
  REQUIRE(points.sensors.size() == 4);
  CHECK(points.marks == std::vector<std::string>{"", "inside an object or a closed room", "",
                                                 "less than 1 cm from a surface"});
  CHECK(counted_marks(points).size() == 2);
}

}  // namespace photile::test
