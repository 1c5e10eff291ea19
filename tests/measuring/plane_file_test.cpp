// Planes of sensors described as JSON.
#include <catch2/catch.hpp>
#include <fstream>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

using Catch::Contains;

namespace {

std::vector<measuring::SensorGrid> planes_in(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "plane.json";
  std::ofstream(file) << text;
  return measuring::read_planes(file);
}

}  // namespace

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

TEST_CASE("what is no plane is refused by file, plane and key") {
  const auto [text, expected] = GENERATE(table<std::string, std::string>({
      {"{", "no JSON"},
      {"[]", "no plane"},
      {"[3]", "plane 1"},
      {R"({"u": [1,0,0], "v": [0,1,0]})", "'origin'"},
      {R"({"origin": [0,0], "u": [1,0,0], "v": [0,1,0]})", "'origin'"},
      {R"({"origin": [0,0,"a"], "u": [1,0,0], "v": [0,1,0]})", "'origin'"},
      {R"({"origin": [0,0,1e300], "u": [1,0,0], "v": [0,1,0]})", "'origin'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [1,1,0]})", "right angle"},
      {R"({"origin": [0,0,0], "u": [0,0,0], "v": [0,1,0]})", "no length"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 0})", "'spacing'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 1e-9})", "'spacing'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "columns": 2})", "'rows'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "columns": 1.5, "rows": 1})",
       "'columns'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "columns": 9999, "rows": 9999})",
       "points"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "space": 1})", "'space'"},
      {R"({"origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "name": 7})", "'name'"},
  }));
  INFO(text);
  CHECK_THROWS_AS(planes_in(text), InputError);
  CHECK_THROWS_WITH(planes_in(text), Contains("plane.json") && Contains(expected));
}

}  // namespace photile::test
