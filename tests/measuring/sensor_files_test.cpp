// Files that say where to measure.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
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
