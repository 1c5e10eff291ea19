// `photile daylight`, daylight factors and skies of other hours on the command line.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"
#include "command/daylight_options.hpp"
#include "report/daylight_tables.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// Over a grid, by few photons and rays: seconds, not accuracy.
template <class... Parts>
std::vector<std::string> quick(const char* command, const std::string& scene,
                               const Parts&... more) {
  return typed(command, scene,
               "--photons 20k --rays 64 --repeats 2 --plane floor+0.75 --wall-band 0.2 "
               "--inside 0,0,0",
               more...);
}

/// A quick year of an even sky of 145 patches.
template <class... Parts>
std::vector<std::string> year_of(const FileFolder& folder, const std::string& scene,
                                 const Parts&... more) {
  return quick("daylight", scene, "--quiet --patches 145 --weather", write_weather(folder),
               more...);
}

}  // namespace

TEST_CASE("a year of daylight fills its files") {
  const FileFolder folder;
  const Outcome outcome =
      succeed(year_of(folder, write_open_box(folder), "--lamps-to 500 -o", folder / "a.CSV", "-o",
                      folder / "a.json", "-o", folder / "a.svg", "-o", folder / "a.html",
                      "--honeybee", folder / "bee"));
  CHECK_THAT(folder.read("a-1.svg"), Contains("working plane: DA 300 lux"));
  CHECK_THAT(folder.read("a-2.svg"), Contains("working plane: UDI 100 to 3000 lux"));
  CHECK_THAT(folder.read("a.html"),
             Contains("A year of daylight: open.obj") && Contains("Maps: working plane</h2>") &&
                 Contains("DA 300 lux") && Contains("year.epw") && !Contains("Key figures"));
  CHECK_THAT(outcome.output, Contains("sDA 300") && Contains("ASE") && Contains("UDI") &&
                                 Contains("EN 17037") && Contains("kWh"));
  const auto record = folder.json("a.json");
  const auto& grid = record.at(0);
  const std::size_t points = grid["points"];
  REQUIRE(grid["sensors"].size() == points);
  CHECK(grid["mean_lux"].get<double>() > 10);
  CHECK(grid["lamps"].size() == 2);
  CHECK(grid["EN 17037"]["median_outdoor_lux"] > 0);
  // The table has the figures of the JSON, rounded.
  std::istringstream table(folder.read("a.CSV"));  // capitals are as good
  std::string line;
  std::getline(table, line);
  CHECK_THAT(line, Contains("relative_error,da,cda,udi_below_100,udi_100_300,udi_300_3000,udi"));
  for (const auto& sensor : grid["sensors"]) {
    REQUIRE(std::getline(table, line));
    std::istringstream fields(line);
    std::vector<std::string> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(field);
    REQUIRE(values.size() >= 18);
    const auto& useful = sensor["UDI"];
    const std::vector<double> expected{sensor["DA"],          sensor["cDA"],
                                       useful["below 100"],   useful["100 to 300"],
                                       useful["300 to 3000"], useful["above 3000"]};
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CHECK(std::stod(values[10 + i]) == Approx(expected[i]).margin(6e-5));
    }
  }
  const std::string up = folder.read("bee/sun-up-hours.txt");
  const auto hours = std::count(up.begin(), up.end(), '\n');
  CHECK(hours > 4300);
  CHECK(hours < 4500);
  CHECK_THAT(folder.read("bee/__static_apertures__/default/total/working_plane.npy"),
             Contains(fmt::format("'shape': ({}, {})", points, hours)));
}

TEST_CASE("the window's year is that of photile daylight, and is refined") {
  const FileFolder folder;
  const std::string scene = write_open_box(folder), weather = write_weather(folder);
  const Outcome once = succeed(quick("daylight", scene, "--quiet --weather", weather));
  app::DaylightOptions options;
  options.render.scene = scene;
  options.render.load.situation.weather = weather;
  options.parameters.repeats = 2;
  options.parameters.gathering.rays = 64;
  options.places.plane = "floor+0.75";
  options.places.layout.wall_band = 0.2;
  options.places.inside = {0, 0, 0};
  options.seconds = 1e-3;
  std::vector<std::string> told;
  app::refine_year(
      options,
      [&](const std::vector<std::string>& lines) {
        told.push_back(fmt::format("{}\n", fmt::join(lines, "\n")));
      },
      Progress::none());
  REQUIRE(told.size() == 3);  // after one round, two and four
  CHECK(told.front() == once.output);
  CHECK_THAT(told.back(), Contains("UDI") && Contains("+-") && Contains("(certain)"));
}

TEST_CASE("in a given time figures get standard errors, and sDA a verdict") {
  const FileFolder folder;
  const Outcome outcome = succeed(
      year_of(folder, write_open_box(folder), "--for 1ms --lux 100000 -o", folder / "a.json"));
  CHECK_THAT(outcome.output, Contains("0.0 +-0% of the points: misses 55% (certain)") &&
                                 Contains("% below 100 lux, ") && !Contains("warning"));
  const auto grid = folder.json("a.json").at(0);
  CHECK(grid["standard_errors"]["mean_lux"] > 0);
  CHECK(grid["standard_errors"]["mean_lux"] < 0.1 * grid["mean_lux"].get<double>());
  CHECK(grid["standard_errors"]["sDA"] == 0);
  CHECK(grid["sensors"][0].contains("DA_error"));
}

TEST_CASE("lamps take the watts that their files state, others those of an efficacy") {
  const FileFolder folder;
  const std::string scene = write_open_box(folder);
  folder.write("spot.ies",
               "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.1 0.1 0\n1 1 25\n"
               "0 45 90\n0\n1000 707.107 0\n");
  folder.write("lamps.json", R"({"name": "new", "file": "spot.ies", "position": [0, 0.9, 0]})");
  const auto watts = [&](const std::string& efficacy) {
    succeed(year_of(folder, scene, "--lamps-to 500 --lamp-efficacy", efficacy, "--luminaires",
                    folder / "lamps.json", "-o", folder / "a.json"));
    std::map<std::string, double> found;
    const auto record = folder.json("a.json");
    for (const auto& lamp : record.at(0).at("lamps")) found[lamp["name"]] = lamp["watts"];
    return found;
  };
  auto some = watts("50"), fewer = watts("100");
  CHECK(some.at("new") == Approx(25));
  CHECK(fewer.at("new") == Approx(25));
  CHECK(some.at("left") > 0);
  CHECK(fewer.at("left") == Approx(some.at("left") / 2));
}

TEST_CASE("blinds close by the hour, as a scene of their own says") {
  const FileFolder folder;
  const std::string scene = write_open_box(folder);
  folder.write("closed.obj", box_obj());
  const Outcome outcome = succeed(year_of(folder, scene, "--blinds", folder / "closed.obj",
                                          "--days mon-fri --set ground=0.3 -o", folder / "a.csv",
                                          "-o", folder / "a.json", "--honeybee", folder / "bee"));
  CHECK_THAT(outcome.output, Contains("blinds closed"));
  const auto grid = folder.json("a.json").at(0);
  CHECK(grid["occupied_hours"] == 2600);
  const auto& states = grid["blinds"]["states"];
  REQUIRE(states.size() == 2);
  // A box that is closed is dark; by schedule it is dark in some hours.
  CHECK(states[1]["mean_lux"] == 0);
  CHECK(states[0]["mean_lux"] > grid["mean_lux"]);
  CHECK(grid["mean_lux"] > 0);
  CHECK(grid["ASE"] == states[0]["ASE"]);
  std::size_t closed = 0;
  for (const std::size_t state : grid["blinds"]["state_of_hour"]) closed += state;
  CHECK(closed == grid["blinds"]["closed_hours"]);
  CHECK_THAT(folder.read("a.csv"),
             Contains(",blinds,ground_reflectance\n") && Contains(",closed,0.3\n"));
  CHECK(folder.json("bee/states_schedule.json")["blinds"]["schedule"] ==
        grid["blinds"]["state_of_hour"]);
  CHECK(!folder.read("bee/blinds/1_blinds/direct/working_plane.npy").empty());
}

TEST_CASE("a room that no sky shines into is warned of") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl());
  const std::string closed = folder.write("closed.obj", box_obj());
  const std::string weather = write_weather(folder);
  const Outcome year = succeed(quick("daylight", closed, "--weather", weather));
  CHECK_THAT(year.errors, Contains("no skylight") && Contains("glass"));
  // Without daylight lamps stay on in every hour, here at a share of their power over one point.
  succeed(quick("daylight", closed, "--quiet --lamps-to 1e-3 --spacing 9 --weather", weather, "-o",
                folder / "lamps.json"));
  const auto grid = folder.json("lamps.json").at(0);
  REQUIRE(grid["points"] == 1);
  for (const auto& lamp : grid["lamps"]) {
    CHECK(lamp["kilowatt_hours"] > 0);
    CHECK(lamp["kilowatt_hours"] < 0.5 * lamp["undimmed_kilowatt_hours"].get<double>());
  }
  const Outcome factors = succeed(quick("measure", closed, "--daylight-factor"));
  CHECK_THAT(factors.errors, Contains("no skylight") && Contains("glass"));
  // The same as lux, as a picture, at eyes and on a page.
  const auto errors_of = [&](std::vector<std::string> words) {
    return succeed(typed(words, "--sky overcast=10000 --light left=off --light right=off -q"))
        .errors;
  };
  const std::string eyes = folder.write("eyes.pts", "0 0 0.5 0 0 -1\n");
  const std::string told = "no skylight reaches any ";
  CHECK_THAT(errors_of(quick("measure", closed)),
             Contains(told + "point") && Contains("has any light"));
  CHECK_THAT(errors_of(typed("render", closed, "--quality draft --photons 20k --size 16x12 -o",
                             folder / "a.exr")),
             Contains(told + "part of the picture"));
  CHECK_THAT(errors_of(typed("glare", closed, "--ratings ugr --photons 20k --rays 64 --repeats 2",
                             "--observers", eyes)),
             Contains(told + "observer"));
  CHECK_THAT(errors_of(typed("publish", closed, "--quality draft --photons 20k --texel 0.2 -o",
                             folder / "a.html")),
             Contains(told + "surface that a camera sees"));
}

TEST_CASE("next to no light of the sky is told of with how much it is") {
  CHECK_THAT(report::darkness_warning(0), Contains("no skylight reaches any point"));
  CHECK_THAT(report::darkness_warning(0.0123),
             Contains("hardly any skylight") && Contains("0.012%") && Contains("glass"));
  CHECK(report::darkness_warning(0.11).empty());
}

TEST_CASE("daylight factors are per cent of the sky's lux") {
  const FileFolder folder;
  const std::string scene = write_open_box(folder);
  const auto run = [&](const char* more) {
    succeed(quick("measure", scene, "--quiet", more, "-o", folder / "df.json", "-o",
                  folder / "df.html"));
    return folder.json("df.json");
  };
  const auto factors = run("--daylight-factor");
  CHECK(factors["unit"] == "DF %");
  CHECK_THAT(folder.read("df.html"),
             Contains("<h1>Daylight factors: open.obj") && Contains("D<sub>m</sub> %"));
  const auto lux = run("--sky overcast=5000");
  const auto& lights = lux["grids"][0]["lights"];
  const double sky = lights["sky"]["Em"]["value"], ground = lights["ground"]["Em"]["value"];
  CHECK(factors["grids"][0]["statistics"]["Em"]["value"].get<double>() ==
        Approx((sky + ground) / 50).epsilon(0.05));  // other photons: 5,000 lux have more
}

TEST_CASE("the daylight factor of a wall in the open has the sky and the ground that it lights") {
  const FileFolder folder;
  // Far below, so that the points see all of the sky and of the ground.
  const std::string scene =
      folder.write("plate.obj", "v 0 -1 0\nv 0.01 -1 0\nv 0.01 -1 0.01\nv 0 -1 0.01\nf 4 3 2 1\n");
  const std::string points = folder.write("p.pts", "0 0 0 0 1 0\n0 0 0 1 0 0\n0 0 0 0 -1 0\n");
  const auto factors = [&](const std::vector<std::string>& more) {
    const Outcome outcome = succeed(
        typed("measure", scene, "--daylight-factor --rays 20k --repeats 4 --integrator path",
              "--points", points, "-o", folder / "a.json", "-o", folder / "a.csv", more));
    const auto record = folder.json("a.json");
    std::vector<double> values;
    for (const auto& sensor : record["grids"][0]["sensors"]) values.push_back(sensor["lux"]);
    return std::tuple{values, record, outcome.output};
  };
  // Of an overcast sky a wall has Lz / 3 (pi / 2 + 4 / 3), open ground 7 pi Lz / 9; of the ground a
  // wall has half of what it sends out, a ceiling all.
  constexpr double pi = 3.14159265358979;
  const double of_sky = 100 * 3 * (pi / 2 + 4.0 / 3) / (7 * pi);
  const auto [values, record, text] = factors({});
  CHECK(values[0] == Approx(100).epsilon(0.01));
  CHECK(values[1] == Approx(of_sky + 10).epsilon(0.01));
  CHECK(values[2] == Approx(20).epsilon(0.01));
  CHECK(record["ground_reflectance"] == 0.2);
  CHECK_THAT(text, Contains("ground: reflectance 0.2"));
  CHECK_THAT(folder.read("a.csv"), Contains(",ground_reflectance\n") && Contains(",0.2\n"));
  const auto [half, half_record, half_text] = factors({"--set", "ground=0.5"});
  CHECK(half[1] == Approx(of_sky + 25).epsilon(0.01));
  CHECK_THAT(half_text, Contains("ground: reflectance 0.5"));
  const auto [black, black_record, black_text] = factors({"--set", "ground=0"});
  CHECK(black[1] == Approx(of_sky).epsilon(0.01));
  CHECK(black_record["ground_reflectance"] == 0);
}

TEST_CASE("a picture of patches takes the sky of another hour") {
  const FileFolder folder;
  const std::string scene = write_open_box(folder), weather = write_weather(folder);
  succeed(typed("render", scene,
                "--sky patches=145 --quality draft --photons 20k --size 8x6 --quiet -o",
                folder / "sky.exr"));
  succeed({"relight", folder / "sky.exr", "--weather", weather, "--time", "2026-06-21T12:00", "-o",
           folder / "noon.png"});
  const Outcome lacking = run_photile(
      {"relight", folder / "sky.exr", "--time", "2026-06-21T12:00", "-o", folder / "x.png"});
  CHECK(lacking.exit_code == 2);
  CHECK_THAT(lacking.errors, Contains("--weather"));
}

}  // namespace photile::test
