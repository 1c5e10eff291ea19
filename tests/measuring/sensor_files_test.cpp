// Files that say where to measure.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "report/honeybee_files.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;
using nlohmann::json;

// Files of sensor points as Radiance and Honeybee write them.

measuring::SensorGrid points_in(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.pts";
  std::ofstream(file) << text;
  return measuring::read_points(file);
}

TEST_CASE("points are read with blanks, tabs, commas, comments and line ends of any kind") {
  const auto grid = points_in(
      "\xEF\xBB\xBF# sensors\n1 2 0.75 0 0 1\r\n\n 1.5,2,7.5e-1, 0,0,2\n\t+2\t-2\t.75\t1\t0\t-1");
  CHECK(grid.name == "desk");
  CHECK_FALSE(grid.layout);
  REQUIRE(grid.sensors.size() == 3);
  CHECK(grid.sensors[0].position == glm::dvec3(1, 2, 0.75));
  CHECK(grid.sensors[1].position == glm::dvec3(1.5, 2, 0.75));
  CHECK(grid.sensors[1].normal == glm::dvec3(0, 0, 1));
  CHECK(grid.sensors[2].position == glm::dvec3(2, -2, 0.75));
  CHECK(glm::length(grid.sensors[2].normal) == Approx(1));
  CHECK(points_in("0 0 0 0 0 1\r1 0 0 0 0 1\r").sensors.size() == 2);
}

// Planes of sensors described as JSON.

std::vector<measuring::SensorGrid> planes_in(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "plane.json";
  std::ofstream(file) << text;
  return measuring::read_planes(file);
}

TEST_CASE("a plane has its sensors in the middles of its cells, row by row") {
  const auto grids = planes_in(R"({"name": "desk", "origin": [1, 2, 0.75], "u": [2, 0, 0],
                              "v": [0, 1, 0], "spacing": 0.5})");
  REQUIRE(grids.size() == 1);
  CHECK(grids[0].name == "desk");
  REQUIRE(grids[0].sensors.size() == 8);
  CHECK(grids[0].sensors[0].position == glm::dvec3(1.25, 2.25, 0.75));
  CHECK(grids[0].sensors[5].position == glm::dvec3(1.75, 2.75, 0.75));
  CHECK(grids[0].sensors[0].normal == glm::dvec3(0, 0, 1));
  REQUIRE(grids[0].layout);
  CHECK(grids[0].layout->columns == 4);
  CHECK(grids[0].layout->rows == 2);
  CHECK(grids[0].layout->spacing() == Approx(0.5));
}

TEST_CASE("a list of planes, with columns and rows or the spacing of the standard") {
  const auto grids = planes_in(R"([{"origin": [0,0,0], "u": [0,0,5], "v": [5,0,0]},
      {"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "columns": 3, "rows": 2}])");
  REQUIRE(grids.size() == 2);
  CHECK(grids[0].name == "plane1");
  CHECK(grids[0].sensors.size() == 64);
  CHECK(grids[0].sensors[0].normal == glm::dvec3(0, 1, 0));
  CHECK(grids[1].sensors.size() == 6);
}

/// A desk with two wings, 0.8 m deep: 2 x 0.8 + 0.8 x 0.8 m2.
constexpr const char* desk_with_wings =
    R"("origin": [1, 0.75, 3], "u": [2, 0, 0], "v": [0, 0, -1.6],
    "outline": [[0, 0], [2, 0], [2, 0.8], [0.8, 0.8], [0.8, 1.6], [0, 1.6]])";

TEST_CASE("an outline keeps the points within it, whose cells have its area") {
  const auto desk = planes_in(fmt::format(R"({{{}, "spacing": 0.1}})", desk_with_wings));
  REQUIRE(desk.size() == 1);
  CHECK(desk[0].sensors.size() == 224);
  for (const Sensor& sensor : desk[0].sensors) {
    CHECK((sensor.position.x < 1.8 || sensor.position.z > 2.2));
  }
  // No middle lies on the diagonal, about which the cells are symmetric: half of 20 x 16.
  const auto half = planes_in(R"({"origin": [0,0,0], "u": [0,2,0], "v": [1.6,0,0],
      "outline": [[0,0], [0,1.6], [2,0], [0,0]], "spacing": 0.1})");
  CHECK(half[0].sensors.size() == 160);
}

TEST_CASE("surroundings and background of an outline are bands of their width around it") {
  const auto grids = planes_in(fmt::format(
      R"({{{}, "spacing": 0.02, "surroundings": 0.3, "background": 0.4}})", desk_with_wings));
  REQUIRE(grids.size() == 3);
  // Strips along 7.2 m of border, quarters of a disc at five corners; two strips overlap at the
  // sixth.
  const double cell = 0.02 * 0.02;
  CHECK(static_cast<double>(grids[1].sensors.size()) * cell ==
        Approx(7.2 * 0.3 + (1.25 * glm::pi<double>() - 1) * 0.3 * 0.3).epsilon(0.02));
  const auto from_wing = [](const Sensor& sensor, double width, double depth) {
    const glm::dvec2 at(sensor.position.x - 1, 3 - sensor.position.z), size(width, depth);
    return glm::length(glm::max(glm::max(-at, at - size), 0.0));
  };
  CHECK(grids[2].sensors.size() > 20);
  for (const Sensor& sensor : grids[2].sensors) {
    const double gap = std::min(from_wing(sensor, 2, 0.8), from_wing(sensor, 0.8, 1.6));
    CHECK((gap >= 0.3 && gap <= 0.7));
  }
}

TEST_CASE("a right angle is one to a millionth, however long its sides are") {
  CHECK(planes_in(R"({"origin": [0,0,0], "u": [10,0,0], "v": [5e-6,10,0]})").size() == 1);
}

TEST_CASE("no grid's name leads out of Honeybee's folder, and none hides another") {
  const auto up = report::honeybee_names({{"desk 1", {}, {}}, {"../up", {}, {}}});
  CHECK(up == std::vector<std::string>{"desk_1.res", "_._up.res"});
  CHECK_THROWS_AS(report::honeybee_names({{"a b", {}, {}}, {"a_b", {}, {}}}), UsageError);
}

}  // namespace
}  // namespace photile::test
