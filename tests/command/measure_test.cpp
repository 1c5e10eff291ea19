// `photile measure`: tables and files.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// Few photons and rays: seconds, not accuracy.
template <class... Parts>
std::vector<std::string> measure(const std::string& scene, const Parts&... more) {
  return typed("measure", scene, "--photons 20k --rays 64 --repeats 3 --quiet", more...);
}

double ratio_of(const std::string& a, const std::string& b) {
  const auto first = nlohmann::json::parse(a), second = nlohmann::json::parse(b);
  return first["grids"][0]["statistics"]["Em"]["value"].get<double>() /
         second["grids"][0]["statistics"]["Em"]["value"].get<double>();
}

/// 1000 cd downwards, level to the horizon: pi x 1000 lm.
void write_spot(const FileFolder& folder, const std::string& name, const std::string& watts) {
  folder.write(name + ".ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.1 0.1 0\n1 1 " +
                                  watts + "\n0 45 90\n0\n1000 707.107 0\n");
}

}  // namespace

TEST_CASE("measure writes the same values to all of its files") {
  const FileFolder folder;
  const Outcome outcome =
      succeed(measure(write_box(folder), "--plane floor+0.75 --wall-band 0.2 -o", folder / "a.csv",
                      "-o", folder / "a.json", "-o", folder / "a.svg", "-o", folder / "a.html",
                      "--honeybee", folder / "bee", "--pal viridis -s auto"));
  CHECK_THAT(outcome.output, Contains("working plane") && Contains("Uo") && Contains("left"));

  const auto record = folder.json("a.json");
  CHECK(record["unit"] == "lux");
  CHECK(record["repeats"] == 3);
  const auto& grid = record["grids"][0];
  const std::size_t points = grid["points"];
  REQUIRE(points > 4);
  REQUIRE(grid["sensors"].size() == points);
  CHECK(grid["statistics"]["Uo"]["value"].get<double>() ==
        Approx(grid["statistics"]["Emin"]["value"].get<double>() /
               grid["statistics"]["Em"]["value"].get<double>()));

  std::istringstream csv(folder.read("a.csv"));
  std::istringstream res(folder.read("bee/working_plane.res"));
  std::string line, value;
  std::getline(csv, line);
  CHECK(line ==
        "grid,point,x,y,z,dx,dy,dz,lux,standard_error,lux left,standard_error left,"
        "lux right,standard_error right");
  for (const auto& sensor : grid["sensors"]) {
    REQUIRE(std::getline(res, value));
    REQUIRE(std::getline(csv, line));
    const double lux = sensor["lux"];
    CHECK(std::stod(value) == Approx(lux).epsilon(1e-5));
    CHECK_THAT(line, Contains("," + value + ","));
    CHECK(sensor["lights"]["left"]["lux"].get<double>() +
              sensor["lights"]["right"]["lux"].get<double>() ==
          Approx(lux).epsilon(1e-5));
    CHECK(sensor["standard_error"].get<double>() > 0);
    CHECK(sensor["position"][1].get<double>() == Approx(-0.25));
  }
  CHECK_FALSE(std::getline(res, value));
  CHECK_THAT(folder.read("a.svg"), Contains("<svg") && Contains("lux") && Contains("</svg>"));
  CHECK_THAT(folder.read("a.html"), Contains("E<sub>m</sub>") && Contains("</svg>") &&
                                        Contains("</html>") && Contains(">Luminaires</h2>") &&
                                        Contains("<td>right</td>") && Contains(" lm</td>") &&
                                        !Contains(" W)") && Contains(">Reflectances</h2>") &&
                                        Contains("<dt>seed</dt>"));
}

TEST_CASE("a report shows the moods of a picture, and is printed as PDF") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  folder.write("moods.json",
               R"({"photile_moods": 1, "moods": {"dusk": {"left": {"power": 1, "unit": "W"}}}})");
  succeed(typed("render", scene, "-o", folder / "box.exr",
                "--size 16x12 --quality draft --photons 2k -k 20 --quiet"));
  succeed(measure(scene, "--plane floor+0.75 --wall-band 0.2 -o", folder / "a.html", "-o",
                  folder / "a.pdf", "--picture", folder / "box.exr", "--moods",
                  folder / "moods.json"));
  CHECK_THAT(folder.read("a.html"), Contains("data:image/png;base64,iVBORw0KGgo") &&
                                        Contains("<figcaption>as rendered</figcaption>") &&
                                        Contains("<figcaption>dusk</figcaption>"));
  CHECK_THAT(folder.read("a.pdf"), Catch::StartsWith("%PDF"));
}

TEST_CASE("measure tells what is seldom meant, with --quiet, too") {
  const FileFolder folder;
  std::string materials = box_mtl(), box = box_obj();
  materials.replace(materials.find("Kd 0.7 0.6 0.5"), 14, "Kd 0.98 0.98 0.98");
  folder.write("box.mtl", materials + "newmtl dim\nKd 0 0 0\nKe 1e-6 1e-6 1e-6\n");
  // Above the ceiling, and a spark within the room.
  box +=
      "v -0.2 2 -0.2\nv 0.2 2 -0.2\nv 0.2 2 0.2\nv -0.2 2 0.2\n"
      "o outside\nusemtl red_lamp\nf 17 18 19 20\n"
      "v -0.2 0.98 -0.2\nv 0.2 0.98 -0.2\nv 0.2 0.98 0.2\nv -0.2 0.98 0.2\n"
      "o spark\nusemtl dim\nf 21 22 23 24\n";
  const Outcome told =
      succeed(measure(folder.write("box.obj", box), "--plane floor+0.75 --spacing 0.5"));
  CHECK_THAT(
      told.errors,
      Contains("warning: 1 material on 12 triangles reflect 95% of light and more, 'wall' 98%"));
  CHECK_THAT(told.errors,
             Contains("warning: light 'spark' emits") && Contains("less than a candle"));
  CHECK_THAT(told.errors, Contains("warning: light 'outside' reaches no point"));
  CHECK_THAT(told.errors, !Contains("light 'left'") && !Contains("light 'right'"));

  // A sound room passes in silence.
  const FileFolder other;
  const Outcome sound = succeed(measure(write_box(other), "--plane floor+0.75 --spacing 0.5"));
  CHECK_THAT(sound.errors, !Contains("warning"));
}

TEST_CASE("a report's picture of other reflectances than are measured is told") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  succeed(typed("render", scene, "--photons 5k --size 16x12 --samples 1 --quiet -o",
                folder / "as_is.exr"));
  const auto report = [&](const char* more) {
    return succeed(measure(scene, "--plane floor+0.75 --spacing 0.5 -o", folder / "a.html",
                           "--picture", folder / "as_is.exr", more));
  };
  CHECK_THAT(report("").errors, !Contains("shows other"));
  CHECK_THAT(report("--reflectance wall=0.3").errors,
             Contains("warning: ") && Contains("as_is.exr shows other surfaces or reflectances"));
}

TEST_CASE("points of Radiance are measured in their order, with paths or photons alike") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string points = folder.write("two.pts", "0 -0.5 0  0 1 0\n0 -0.5 0  0 -1 0\n");
  std::vector<std::string> files;
  for (const std::string integrator : {"photon-map", "path"}) {
    files.push_back(folder / (integrator + ".json"));
    succeed(typed("measure", scene, "--points", points, "--rays 2k --integrator", integrator, "-o",
                  files.back(), integrator == "photon-map" ? "--photons 200k" : ""));
    const auto grid = folder.json(integrator + ".json")["grids"][0];
    CHECK(grid["name"] == "two");
    CHECK(grid["sensors"][0]["lux"].get<double>() > 2 * grid["sensors"][1]["lux"].get<double>());
  }
  CHECK(ratio_of(folder.read("photon-map.json"), folder.read("path.json")) ==
        Approx(1).epsilon(0.03));
}

TEST_CASE("the maintenance factor and --light scale what is measured") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto run = [&](const char* more) {
    succeed(measure(scene, "--plane floor+0.5 -o", folder / "a.json", more));
    return folder.read("a.json");
  };
  const std::string plain = run("");
  CHECK(ratio_of(run("--maintenance 0.8"), plain) == Approx(0.8));
  CHECK(ratio_of(run("--maintenance LLMF=0.9,LMF=80%"), plain) == Approx(0.72));
  CHECK(ratio_of(run("--light left=x2 --light right=x2"), plain) == Approx(2).epsilon(1e-5));
  CHECK(run("") == plain);
  CHECK(run("--threads 1") == plain);
}

TEST_CASE("a luminaire's own maintenance factor takes the place of the measurement's") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  write_spot(folder, "spot", "30");
  const auto run = [&](const std::string& first, const std::string& second) {
    // Mirror images in a box that is one of itself.
    const std::string lamp =
        R"("file": "spot.ies", "circuit": "all", "kelvin": 2700, "position": )";
    folder.write("lamps.json", "[{" + lamp + "[-0.4, 0.9, 0]" + first + "}, {" + lamp +
                                   "[0.4, 0.9, 0]" + second + "}]");
    succeed(typed("measure", scene,
                  "--photons 20k --rays 1024 --repeats 3 --quiet --light left=off",
                  "--light right=off --plane floor+0.5 --maintenance 0.8 --luminaires",
                  folder / "lamps.json", "-o", folder / "a.json", "-o", folder / "a.html"));
    return folder.read("a.json");
  };
  const std::string plain = run("", ""), own = R"(, "maintenance": 0.4)";
  CHECK(ratio_of(run(own, own), plain) == Approx(0.5).epsilon(0.02));  // other photons
  CHECK(ratio_of(run(own, ""), plain) == Approx(0.75).epsilon(0.02));
  const auto files = folder.json("a.json")["photometry"];
  REQUIRE(files.size() == 2);
  CHECK(files[0]["maintenance_factor"] == 0.4);
  CHECK(files[1]["kelvin"] == 2700);
  CHECK(files[0]["lumens"] == files[1]["lumens"]);  // those of new lamps
  CHECK(files[0]["watts"].get<double>() == Approx(30));
  CHECK_THAT(folder.read("a.html"), Contains("<dt>colour temperature</dt><dd>2700 K</dd>") &&
                                        Contains("<th>maintenance factor</th>"));
}

TEST_CASE("a target is judged in the table, the JSON and the report") {
  const FileFolder folder;
  folder.write("desk.json", R"({"origin": [0, -0.2, 0.5], "u": [0.5, 0, 0], "v": [0, 0, -0.5],
      "surroundings": 0.2, "target": "Em=99999"})");
  const Outcome outcome =
      succeed(measure(write_box(folder),
                      "--plane floor+0.75 --walls --ceiling --cylindrical-at floor+1.2 "
                      "--semi-cylindrical-at floor+1.2 --target Em=1,Uo=0.999,Ewall=1 --grid",
                      folder / "desk.json", "-o", folder / "a.json", "-o", folder / "a.html"));
  CHECK_THAT(outcome.output, Contains("working plane: Em") && Contains("at least 1: met") &&
                                 Contains("NOT MET") && Contains("east wall") &&
                                 Contains("semi-cylindrical to the west"));
  const auto record = folder.json("a.json");
  const auto &own = record["targets"][0], &others = record["targets"][1];
  CHECK(own["judgements"].size() == 3);  // Em of the desk, Em and Uo of its surroundings
  CHECK(own["judgements"][1]["required"] == 500);
  CHECK(others["judgements"][0]["met"] == true);
  CHECK(others["judgements"][1]["met"] == false);
  CHECK(record["grids"].size() == 2 + 1 + 4 + 1 + 1 + 4);
  CHECK_THAT(folder.read("a.html"), Contains("not met") && Contains("<p>Em=99999</p>"));
}

TEST_CASE("emergency lighting is measured by direct light alone") {
  const FileFolder folder;
  folder.write("axis.pts", "-0.6 -0.9 0 0 1 0\n-0.6 0 0 0 1 0\n");
  succeed(typed("measure", write_box(folder),
                "--photons 5k --rays 1024 --quiet --light right=off --target escape-route",
                "--points", folder / "axis.pts", "-o", folder / "a.json"));
  // Of the form factor of a square, from a point on its axis to a quarter with sides of 0.2 m.
  const auto quarter = [](double height) {
    const double side = 0.2 / height, slant = std::sqrt(1 + side * side);
    return side / slant * std::atan(side / slant);
  };
  const auto sensors = nlohmann::json::parse(folder.read("a.json"))["grids"][0]["sensors"];
  CHECK(sensors[0]["lux"].get<double>() / sensors[1]["lux"].get<double>() ==
        Approx(quarter(1.89) / quarter(0.99)).epsilon(0.005));
}

TEST_CASE("a report has the project, glare and a year beside its figures, and lines to sign on") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  folder.write("glare.json",
               R"({"observers": [{"name": "desk 1", "position": [0, 1.2, 0],
                    "ugr": {"value": 17.2, "standard_error": 0.1},
                    "illuminance": {"value": 300, "standard_error": 2}},
                   {"name": "desk <2>", "position": [1, 1.2, 0],
                    "ugr": {"value": 21.4, "standard_error": 0.1},
                    "illuminance": {"value": 320, "standard_error": 2}}],
                    "plane": {"origin": [-1, 1.2, 1], "u": [3, 0, 0], "v": [0, 0, -2],
                              "columns": 3, "rows": 2}})");
  folder.write("year.json",
               R"([{"name": "desks", "mean_lux": 812.3, "DA": 0.61, "sDA": 0.8, "ASE": 0.07,
                    "EN 17037": {"target_lux": 310, "minimum_target_lux": 120},
                    "target_lux": 300, "plane": {"origin": [0, 0, 0], "u": [1, 0, 0],
                      "v": [0, 0, -1], "columns": 2, "rows": 1},
                    "sensors": [{"position": [0.25, 0, -0.5], "DA": 0.2, "UDI": {
                      "100 to 300": 0.1, "300 to 3000": 0.5}}]}])");
  folder.write("logo.png", "\x89PNG\r\n");
  const Outcome outcome = succeed(
      measure(scene, "--plane floor+0.75 --wall-band 0.2 --target office-desk --project",
              std::string("Office <1>"), "--client", std::string("C & Co"), "--include",
              folder / "glare.json", "--include", folder / "year.json", "--logo",
              folder / "logo.png", "--maintenance LLMF=0.9,LMF=0.95 -o", folder / "a.html"));
  CHECK_THAT(outcome.output, Contains("plane, desk <2>: UGR 21.4, at most 19: NOT MET"));
  const std::string page = folder.read("a.html");
  CHECK_THAT(page, Contains("<dd>Office &lt;1&gt;</dd>") && Contains("C &amp; Co") &&
                       Contains("signature") && Contains(">Glare</h2>") &&
                       Contains("desk &lt;2&gt;") && Contains(">A year of daylight</h2>") &&
                       Contains("80.0%") && Contains(">310<"));
  CHECK_THAT(page, Contains("DA 300 lux") && Contains("UDI 100 to 3000 lux") &&
                       Contains("the highest UGR") && Contains("class=\"logo\"") &&
                       Contains("0.855 = LLMF 0.9 x LMF 0.95"));
}

TEST_CASE("a report describes the luminaires, their energy and the room, in two languages") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  // 1000 cd downwards, level to the horizon: pi x 1000 lm, taken from 31.4 W: 100 lm/W.
  folder.write("spot.ies",
               "IESNA:LM-63-2002\n[MANUFAC] Good & Ltd\n[LUMCAT] GL-1\n[LAMP] LED 3000K 90CRI\n"
               "TILT=NONE\n1 -1 1 3 1 1 2 0.1 0.1 0\n1 1 31.41593\n0 45 90\n0\n"
               "1000 707.107 0\n");
  folder.write("lamps.json", R"({"name": "new", "file": "spot.ies", "position": [0, 0.9, 0],
      "count": [2, 1], "spacing": [0.5, 0]})");
  folder.write("year.json",
               R"([{"name": "desks", "mean_lux": 812, "DA": 0.6, "sDA": 0.8, "lamps":
                   [{"name": "new", "kilowatt_hours": 44}],
                   "EN 17037": {"target_lux": 310, "minimum_target_lux": 120}}])");
  const auto report = [&](const std::string& language, const std::string& ra) {
    succeed(measure(scene, "--plane floor+0.75 --wall-band 0.2 --inside 0,0,0 --luminaires",
                    folder / "lamps.json", "--include", folder / "year.json", "--language",
                    language, "--target", "Em=1,Ra=" + ra, "-o", folder / "a.html"));
    return folder.read("a.html");
  };
  const std::string page = report("en", "80");
  CHECK_THAT(page, Contains(">List of parts</h2>") && Contains("Good &amp; Ltd") &&
                       Contains("GL-1") && Contains("3000 K") && Contains("cd/klm"));
  CHECK_THAT(page, Contains("90, by the luminaires&#39; data sheets") ||
                       Contains("90, by the luminaires' data sheets"));
  // The box is 2 x 2 m and 2 m high.
  CHECK_THAT(page, Contains("<dd>2.00 m</dd>") && Contains(">Room</h2>") &&
                       Contains("<dt>LENI (EN 15193)</dt>") && Contains("44 kWh / a") &&
                       Contains("W/m² / 100 lx") && Contains("counter(pages)"));
  CHECK_THAT(report("de", "95"), Contains("<html lang=\"de\">") && Contains("Leuchtenstückliste") &&
                                     Contains("erfüllt") && Contains("nicht erfüllt") &&
                                     Contains("Nutzebene") && !Contains("not met"));
}

TEST_CASE("a list of parts totals the power where every file states it") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  write_spot(folder, "a", "30");
  folder.write("lamps.json", R"([{"name": "a", "file": "a.ies", "position": [0, 0.9, 0]},
      {"name": "b", "file": "b.ies", "position": [0.3, 0.9, 0]}])");
  const auto total = [&](const std::string& watts) {
    write_spot(folder, "b", watts);
    succeed(measure(scene, "--plane floor+0.75 --luminaires", folder / "lamps.json", "-o",
                    folder / "a.html"));
    const std::string page = folder.read("a.html");
    const std::size_t at = page.find("together");
    REQUIRE(at != std::string::npos);
    return page.substr(at, page.find("</tr>", at) - at);
  };
  CHECK_THAT(total("20"), Contains(">50 W<") && Contains("lm/W"));
  CHECK_THAT(total("0"), Contains(" lm<") && !Contains(" W<") && !Contains("lm/W"));
}

TEST_CASE("a scene that lies on its side is measured at the places of its file") {
  const FileFolder folder;
  const std::string upright = write_box(folder);
  std::istringstream lines(box_obj());
  std::string turned, line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string word;
    double x = 0, y = 0, z = 0;
    if (words >> word && word == "v") {
      words >> x >> y >> z;
      line = fmt::format("v {} {} {}", x, 0 - z, y);
    }
    turned += line + "\n";
  }
  const std::string lying = folder.write("lying.obj", turned);
  const std::string points = folder.write("a.pts", "0.3 -0.5 0.2 0 1 0\n0.1 0.2 0.4 1 0 0\n");
  const std::string same = folder.write("b.pts", "0.3 -0.2 -0.5 0 0 1\n0.1 -0.4 0.2 1 0 0\n");
  const auto record = [&](const std::string& scene, const std::string& where, const char* more) {
    succeed(measure(scene, more, "--points", where, "-o", folder / "a.json"));
    return folder.json("a.json")["grids"][0]["sensors"];
  };
  const auto expected = record(upright, points, ""), seen = record(lying, same, "--set up=z");
  REQUIRE(seen.size() == 2);
  CHECK(seen[0]["position"] == nlohmann::json({0.3, -0.2, -0.5}));
  for (std::size_t i = 0; i < 2; ++i) CHECK(seen[i]["lux"] == expected[i]["lux"]);  // to the bit
}

TEST_CASE("a point beyond the walls is blank in every file, and the others keep their places") {
  const FileFolder folder;
  const std::string points =
      folder.write("p.pts", "0 0 0 0 1 0\n9 0 0.1 0 1 0\n0.3 0 0.2 0 1 0\n-0.3 0.1 0.2 0 1 0\n");
  const std::string scene = write_box(folder);
  const Outcome outcome = succeed(measure(scene, "--points", points, "-o", folder / "a.csv", "-o",
                                          folder / "a.json", "--honeybee", folder / "bee"));
  CHECK_THAT(outcome.output, Contains("p: 3 points, and 1 left out"));
  const Outcome told = succeed(typed("measure", scene, "--photons 5k --rays 16 --points", points));
  CHECK_THAT(told.errors, Contains("p: 1 of 4 points are left out: they lie inside a solid or"));
  CHECK_THAT(folder.read("a.csv"), Contains("p,1,9,0,0.1,0,1,0,,,,,,,inside a solid or beyond"));
  const std::string res = folder.read("bee/p.res");
  CHECK(std::count(res.begin(), res.end(), '\n') == 4);
  CHECK_THAT(res, Contains("\nnan\n"));
  const auto grid = folder.json("a.json")["grids"][0];
  CHECK(grid["blank"][0]["before"] == 1);
  CHECK(grid["statistics"]["Emin"]["value"].get<double>() > 0);
}

TEST_CASE("points in a hollow counter are left out of all figures, and the report says so") {
  const FileFolder folder;
  // The counter of five boards without a bottom, x from -0.2 to 0.2, 0.8 m of the box's 2 m high.
  std::string box = box_obj();
  int vertices = 16;
  box += "o counter\nusemtl wall\n";
  const auto quad = [&](const std::string& corners) {
    box += corners +
           fmt::format("f {} {} {} {}\n", vertices + 1, vertices + 2, vertices + 3, vertices + 4);
    vertices += 4;
  };
  quad("v -0.2 -1 -0.2\nv -0.2 -0.2 -0.2\nv -0.2 -0.2 0.6\nv -0.2 -1 0.6\n");
  quad("v 0.2 -1 -0.2\nv 0.2 -0.2 -0.2\nv 0.2 -0.2 0.6\nv 0.2 -1 0.6\n");
  quad("v -0.2 -1 -0.2\nv -0.2 -0.2 -0.2\nv 0.2 -0.2 -0.2\nv 0.2 -1 -0.2\n");
  quad("v -0.2 -1 0.6\nv -0.2 -0.2 0.6\nv 0.2 -0.2 0.6\nv 0.2 -1 0.6\n");
  quad("v -0.2 -0.2 -0.2\nv 0.2 -0.2 -0.2\nv 0.2 -0.2 0.6\nv -0.2 -0.2 0.6\n");
  folder.write("box.mtl", box_mtl());
  const std::string scene = folder.write("box.obj", box);
  const Outcome outcome =
      succeed(measure(scene, "--inside 0,0.5,0 --plane floor+0.5 --spacing 0.13 --wall-band 0.1 -o",
                      folder / "a.json", "-o", folder / "a.html", "-o", folder / "a.svg"));
  const auto grid = folder.json("a.json")["grids"][0];
  REQUIRE(grid["blank"].size() > 8);
  for (const auto& blank : grid["blank"]) {
    CHECK(std::abs(blank["position"][0].get<double>()) < 0.21);
    CHECK_THAT(blank["reason"].get<std::string>(), Contains("inside"));
  }
  CHECK(grid["statistics"]["Emin"]["value"].get<double>() > 0);
  CHECK_THAT(outcome.output, Contains(fmt::format("and {} left out", grid["blank"].size())));
  CHECK_THAT(folder.read("a.html"),
             Contains(fmt::format("{} points are left out: inside", grid["blank"].size())));
  CHECK_THAT(folder.read("a.svg"), Contains("class=\"crosses\""));
}

TEST_CASE("where no point has light, that is told, in the report, too") {
  const FileFolder folder;
  const std::string points = folder.write("p.pts", "0 900 0 0 1 0\n100 900 0 0 1 0\n");
  const Outcome outcome = succeed(measure(write_box(folder), "--points", points, "-o",
                                          folder / "a.html", "-o", folder / "a.json"));
  CHECK_THAT(outcome.errors, Contains("warning: none of the 2 points has any light") &&
                                 Contains("warning: light 'left' reaches no point"));
  CHECK_THAT(folder.read("a.html"), Contains("none of the 2 points has any light"));
  CHECK_THAT(folder.json("a.json")["warnings"].dump(),
             Contains("none of the 2 points has any light"));
}

}  // namespace photile::test
