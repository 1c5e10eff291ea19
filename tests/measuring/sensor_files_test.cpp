// Files that say where to measure.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

#include "measuring/sensor_grid.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/honeybee_files.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
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
      {R"({"origin": [0,0,0], "u": [0.1,0,0], "v": [1e-5,0.1,0]})", "right angle"},
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

// Files for Honeybee.

GridValues grid(const std::string& name, const std::vector<float>& lux) {
  GridValues values;
  values.grid.name = name;
  values.grid.sensors.resize(lux.size());
  const std::vector<std::vector<float>> repeats(2, lux);
  values.lights.push_back({"", means_of(repeats), statistics_of(repeats, 0, lux.size())});
  return values;
}

TEST_CASE("each grid has a .res of its own, listed in grids_info.json") {
  const auto files = report::honeybee_files({grid("desk 1", {250.5f, 500}), grid("floor", {100})});
  CHECK(files.at("desk_1.res") == "250.5\n500\n");
  CHECK(files.at("floor.res") == "100\n");
  const auto info = nlohmann::json::parse(files.at("grids_info.json"));
  REQUIRE(info.size() == 2);
  CHECK(info[0]["name"] == "desk 1");
  CHECK(info[0]["identifier"] == "desk_1");
  CHECK(info[0]["full_id"] == "desk_1");
  CHECK(info[0]["count"] == 2);
  CHECK(info[1]["count"] == 1);
  CHECK(files.at("grid_summary.csv") ==
        "Sensor Grid,Sensor Grid ID,Mean,Minimum,Maximum,Uniformity Ratio\n"
        "desk_1,desk_1,375.25,250.5,500,66.76\nfloor,floor,100,100,100,100\n");
}

TEST_CASE("no grid's name leads out of the folder, and none hides another") {
  const auto files = report::honeybee_files({grid("../up", {1})});
  CHECK(files.count("__up.res") + files.count("_._up.res") == 1);
  for (const auto& [name, text] : files) CHECK(name.find('/') == std::string::npos);
  CHECK_THROWS_AS(report::honeybee_files({grid("a b", {1}), grid("a_b", {1})}), UsageError);
}

// Files of points and planes damaged at random, with fixed seeds: each gives sensors that can be
// measured at, or an InputError of one line that names the file.

void check_sensors(const measuring::SensorGrid& grid) {
  CHECK_FALSE(grid.sensors.empty());
  CHECK(grid.sensors.size() <= limits::max_sensors);
  std::size_t bad = 0;
  for (const auto& sensor : grid.sensors) {
    bad += !(glm::length(sensor.position) < 10 * limits::max_coordinate);
    bad += !(std::abs(glm::length(sensor.normal) - 1) < 1e-9);
  }
  CHECK(bad == 0);
}

/// Reads damaged files one after the other and counts.
struct DamagedFiles {
  void read_points(const std::string& text) {
    read("desk.pts", text, [](const auto& file) { check_sensors(measuring::read_points(file)); });
  }
  void read_planes(const std::string& text) {
    read("desk.json", text, [](const auto& file) {
      for (const auto& grid : measuring::read_planes(file)) check_sensors(grid);
    });
  }

  template <class Read>
  void read(const std::string& name, const std::string& text, const Read& reader) {
    const auto file = folder.path / name;
    std::ofstream(file, std::ios::binary) << text;
    try {
      reader(file);
      ++good;
    } catch (const InputError& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.find(name) != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
      ++refused;
    }
  }

  TemporaryFolder folder;
  int good = 0, refused = 0;
};

std::string with_changes(std::string text, std::mt19937& random) {
  using namespace std::string_view_literals;
  constexpr auto bytes = "0123456789.-+eE, \n\t#naif{}[]\":\0\xFF"sv;
  for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
    text[random() % text.size()] = bytes[random() % bytes.size()];
  }
  return text;
}

const std::string points =
    "# desk\n1 2 0.75 0 0 1\r\n1.5,2,7.5e-1, 0,0,2\n\t+2\t-2\t.75\t1\t0\t-1\n";

json planes() {
  return json::parse(R"([
    {"name": "desk", "origin": [1, 2, 0.75], "u": [2, 0, 0], "v": [0, 1, 0], "spacing": 0.5},
    {"origin": [0, 0, 0], "u": [0, 0, 5], "v": [5, 0, 0]},
    {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "columns": 3, "rows": 2}])");
}

TEST_CASE("points cut anywhere or with bytes replaced are read or refused") {
  std::mt19937 random(21);
  DamagedFiles files;
  for (std::size_t length = 0; length < points.size(); ++length) {
    files.read_points(points.substr(0, length));
  }
  for (int trial = 0; trial < 1'000; ++trial) files.read_points(with_changes(points, random));
  CHECK(files.good > 100);
  CHECK(files.refused > 100);
}

TEST_CASE("planes cut anywhere or with bytes replaced are read or refused") {
  std::mt19937 random(22);
  DamagedFiles files;
  const std::string text = planes().dump();
  for (std::size_t length = 0; length < text.size(); ++length) {
    files.read_planes(text.substr(0, length));
  }
  CHECK(files.good == 0);
  for (int trial = 0; trial < 1'000; ++trial) files.read_planes(with_changes(text, random));
  CHECK(files.good > 20);
  CHECK(files.refused > 100);
}

TEST_CASE("planes with values replaced are read or refused") {
  const json wild =
      json::parse(R"([-1, 0, 1, 7, 1e-12, 1e-300, 1e11, 1e300, -1e9, 0.1, 1e-5, true, null, "", "x",
      [], {}, [0, 0, 0], 18446744073709551615])");
  std::mt19937 random(23);
  DamagedFiles files;
  const json whole = planes();
  for (int trial = 0; trial < 1'000; ++trial) {
    json damaged = whole;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      json& plane = damaged[random() % damaged.size()];
      auto member = plane.begin();
      std::advance(member, random() % plane.size());
      json& value = *member;
      if (value.is_array() && !value.empty() && random() % 2 == 0) {
        value[random() % value.size()] = wild[random() % wild.size()];
      } else {
        value = wild[random() % wild.size()];
      }
    }
    files.read_planes(damaged.dump());
  }
  CHECK(files.good > 20);
  CHECK(files.refused > 100);
}

}  // namespace
}  // namespace photile::test
