// Files of sensor points as Radiance and Honeybee write them.
#include <catch2/catch.hpp>
#include <fstream>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

using Catch::Contains;

namespace {

measuring::SensorGrid points_in(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path / "desk.pts";
  std::ofstream(file) << text;
  return measuring::read_points(file);
}

}  // namespace

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

TEST_CASE("lines that are no points are refused by file and number") {
  const std::string line =
      GENERATE("1 2 3", "1 2 3 0 0 1 7", "1 2 x 0 0 1", "1 2 nan 0 0 1", "1 2 inf 0 0 1",
               "1 2 3 0 0 0", "1 2 1e300 0 0 1", "1 2 3,5m 0 0 1");
  INFO(line);
  CHECK_THROWS_AS(points_in("0 0 0 0 0 1\n" + line + "\n"), InputError);
  CHECK_THROWS_WITH(points_in("0 0 0 0 0 1\n" + line + "\n"), Contains("desk.pts: line 2"));
}

TEST_CASE("a file without points, and one that is not there, are refused") {
  CHECK_THROWS_WITH(points_in("# nothing\n"), Contains("no points"));
  CHECK_THROWS_WITH(measuring::read_points("/nowhere/a.pts"), Contains("no such file"));
}

}  // namespace photile::test
