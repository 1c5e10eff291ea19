// Files for Honeybee.
#include "report/honeybee_files.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "photile/errors.hpp"

namespace photile::test {

using namespace photile::measuring;

namespace {

GridValues grid(const std::string& name, const std::vector<float>& lux) {
  GridValues values;
  values.grid.name = name;
  values.grid.sensors.resize(lux.size());
  const std::vector<std::vector<float>> repeats(2, lux);
  values.lights.push_back({"", means_of(repeats), statistics_of(repeats, 0, lux.size())});
  return values;
}

}  // namespace

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

}  // namespace photile::test
