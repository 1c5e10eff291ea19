// `photile info` against what the written scene is known to hold.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "command/scene_report.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

nlohmann::json info(const std::string& scene, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {"info", "--json", scene});
  const Outcome outcome = succeed(options);
  CHECK(outcome.errors.empty());
  return nlohmann::json::parse(outcome.output);
}

TEST_CASE("info counts the triangles, materials, lights and extents of a box") {
  const FileFolder folder;
  const auto facts = info(write_box(folder));
  CHECK(facts["triangles"] == 16);  // 6 walls and 2 lamps, two triangles each
  REQUIRE(facts["materials"].size() == 3);
  std::size_t triangles = 0;
  for (const auto& material : facts["materials"]) {
    triangles += material["triangles"].get<std::size_t>();
    if (material["name"] == "wall") CHECK(material["triangles"] == 12);
  }
  CHECK(triangles == 16);
  CHECK(facts["lights"].size() == 2);
  CHECK(facts["cameras"].size() == 1);
  CHECK(facts["extents"]["size"] == nlohmann::json::array({2.0, 2.0, 2.0}));
  CHECK(facts["warnings"].empty());
  REQUIRE(facts["rooms"].size() == 1);
  CHECK(facts["rooms"][0]["height"].get<double>() == Approx(2).epsilon(0.01));
  CHECK(facts["rooms"][0]["area"].get<double>() == Approx(4).epsilon(0.01));
}

TEST_CASE("info gives a lamp's power as pi x area x luminance of its radiance") {
  const FileFolder folder;
  const auto facts = info(write_box(folder));
  const auto& left = facts["lights"][0];
  CHECK(left["name"] == "left");
  const double radiance = 0.2126 * 20 + 0.7152 * 5 + 0.0722 * 5;
  const double watts = glm::pi<double>() * 0.4 * 0.4 * radiance;
  CHECK(left["watts"].get<double>() == Approx(watts).epsilon(1e-6));
  CHECK(left["lumens"].get<double>() == Approx(683 * watts).epsilon(1e-6));
}

TEST_CASE("info lists the groups that it is given, with the sum of their lights' powers") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  CHECK(info(scene)["groups"].empty());
  // An option that may be repeated takes one word each time.
  only_error(run_photile({"info", scene, "--light-group", "l*=left", "r*=right"}), usage);
  const auto facts = info(scene, {"--light-group", "*t=both"});
  CHECK(facts["lights"][0]["group"] == "both");
  REQUIRE(facts["groups"].size() == 1);
  CHECK(facts["groups"][0]["name"] == "both");
  CHECK(facts["groups"][0]["lights"] == nlohmann::json{"left", "right"});
  const auto watts = [](const nlohmann::json& light) { return light["watts"].get<double>(); };
  CHECK(watts(facts["groups"][0]) ==
        Approx(watts(facts["lights"][0]) + watts(facts["lights"][1])).epsilon(1e-12));

  const Outcome text = run_photile({"info", scene, "--light-group", "left=own"});
  CHECK_THAT(text.output, Contains("group: own: 1 light, ") && Contains(", of group own"));
  const Outcome none = run_photile({"info", scene, "--light-group", "lamp*=lamps"});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.errors, Contains("'left', 'right'"));
}

TEST_CASE("a luminaire beside an OBJ is stated in lumens and in its electrical watts") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  folder.write("lamp.ies",
               "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.1 0.1 0\n1 1 120\n0 90 180\n0\n"
               "100 100 100\n");
  folder.write("lamps.json", R"([{"name": "tubes", "file": "lamp.ies", "position": [0, 0.9, 0],
                                  "count": [2, 1], "spacing": [0.3, 0]}])");
  const std::vector<std::string> lamps{"--luminaires", folder / "lamps.json"};
  const double lumens = 400 * glm::pi<double>();
  const auto facts = info(scene, lamps);
  REQUIRE(facts["lights"].size() == 4);
  CHECK(facts["lights"][0]["watts"].get<double>() > 0);  // radiant, as OBJ has it
  const auto& tube = facts["lights"][3];
  CHECK(tube["lumens"].get<double>() == Approx(lumens).epsilon(1e-9));
  CHECK(tube["electrical_watts"].get<double>() == Approx(120));
  CHECK(tube["unit"] == "lm");
  CHECK_FALSE(tube.contains("watts"));
  CHECK(facts["groups"][0]["electrical_watts"].get<double>() == Approx(240));
  CHECK_FALSE(facts["groups"][0].contains("watts"));
  const std::string text = succeed(typed("info", scene, lamps)).output;
  CHECK_THAT(text, Contains("photometric, 1257 lm, takes 120 W, of group tubes") &&
                       Contains("group: tubes: 2 lights, 2513 lm\n"));
  // Dimmed, it takes less.
  const std::string picture = folder / "a.exr";
  const Outcome rendered =
      succeed(typed("render", scene, "-o", picture,
                    "--size 16x12 --quality draft --photons 2k -k 20 --light tubes=x0.5", lamps));
  CHECK_THAT(rendered.errors + rendered.output, Contains("628.3 lm, takes 60 W"));
  const std::string relit = succeed({"relight", picture}).output;
  CHECK_THAT(relit,
             Contains("group: tubes: 1257 lm\n") && Contains("light: left: ") && Contains(" W ("));
}

TEST_CASE("info applies the emissive scale and the lumens per watt that it is given") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const double plain = info(scene)["lights"][0]["watts"];
  const auto scaled = info(scene, {"--set", "emissive_scale=10", "--set", "lumen_per_watt=179"});
  CHECK(scaled["lights"][0]["watts"].get<double>() == Approx(10 * plain).epsilon(1e-6));
  CHECK(scaled["lights"][0]["lumens"].get<double>() == Approx(1790 * plain).epsilon(1e-6));
}

TEST_CASE("info as text names every light and material, and what a coat adds to its colour") {
  const FileFolder folder;
  folder.write("box.mtl",
               box_mtl() + "newmtl coated\nKd 0.5 0.5 0.5\nKs 0.3 0.3 0.3\nNs 50\nillum 2\n");
  const std::string scene = folder.write("box.obj", box_obj() + "usemtl coated\nf 1 2 7\n");
  CHECK_THAT(succeed({"info", scene}).output,
             Contains("light: left: area") && Contains("light: right: area") &&
                 Contains("material: wall: diffuse, 12 triangles") &&
                 Contains("room: 4.0 m2, 2.00 x 2.00 m, 2.00 m high") &&
                 Contains("material: coated: glossy, 1 triangle, reflectance 0.65 (0.5 entered, "
                          "and 0.3 specular"));
}

TEST_CASE("info counts what the import dropped, and says so") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl());
  // The first wall again, the other way round, a triangle without area, and one with a corner that
  // is no number.
  const std::string scene = folder.write(
      "box.obj", box_obj() + "v nan -1 -1\nusemtl wall\nf 4 3 2 1\nf 1 2 2\nf 1 2 17\n");
  const auto facts = info(scene);
  CHECK(facts["triangles"] == 16);
  CHECK(facts["degenerate_triangles"] == 1);
  CHECK(facts["duplicate_triangles"] == 2);
  CHECK(facts["non_finite_triangles"] == 1);
  const Outcome text = run_photile({"info", scene});
  CHECK_THAT(text.output, Contains("warning: 1 triangles without area are dropped"));
}

TEST_CASE("info states what panes let through and reflect, however the file makes them") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl() + "newmtl pane\nKd 0 0 0\nd 0.1\n");
  const std::string scene = folder.write(
      "box.obj", box_obj() + "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nusemtl pane\nf -3 -2 -1\n");
  CHECK_THAT(succeed({"info", scene}).output,
             Contains("material: pane: pane, 1 triangle, transmittance 0.9, reflectance 0"));
  const auto material = info(scene)["materials"].back();
  CHECK(material["transmittance"].get<double>() == Approx(0.9));
  CHECK_FALSE(info(scene)["materials"].front().contains("transmittance"));
  CHECK_THAT(succeed({"info", scene, "--reflectance", "pane=0.08"}).output,
             Contains("transmittance 0.9, reflectance 0.08"));
  CHECK_THAT(only_error(run_photile({"info", scene, "--reflectance", "pane=0.2"}), usage),
             Contains("at its brightest it reflects 0.1"));
}

TEST_CASE("info names rough glass, which it treats as smooth") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl() + "newmtl frosted\nillum 7\nNs 80\n");
  const std::string scene = folder.write(
      "box.obj", box_obj() + "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nusemtl frosted\nf -3 -2 -1\n");
  const Outcome text = run_photile({"info", scene});
  CHECK_THAT(text.output,
             Contains("warning: material 'frosted': rough glass (Ns 80) is treated as smooth"));
}

TEST_CASE("info takes the scene of a glTF file that is named, and refuses one that is not there") {
  const FileFolder folder;
  const std::string scene = folder.write("two.gltf", R"({"asset": {"version": "2.0"},
    "scenes": [{"name": "day", "nodes": [0]}, {"name": "night", "nodes": [0, 1]}],
    "nodes": [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0, "translation": [0, 0, 1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"emissiveFactor": [1, 1, 1]}],
    "buffers": [{"byteLength": 36, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
  CHECK(info(scene)["lights"].size() == 1);
  CHECK(info(scene, {"--set", "scene=night"})["lights"].size() == 2);
  CHECK(info(scene, {"--set", "scene=1"})["lights"].size() == 2);
  const Outcome dusk = run_photile({"info", scene, "--set", "scene=dusk"});
  CHECK_THAT(only_error(dusk, 2), Contains("0 'day', 1 'night'"));
}

TEST_CASE("info names solid glass on a single sheet") {
  const FileFolder folder;
  const std::string pane = "v 0.5 0.5 0.5\nv 1 0.5 0.5\nv 1 1 0.5\nusemtl pane\nf -3 -2 -1\n";
  const auto scene = folder.write("box.obj", box_obj() + pane);
  folder.write("box.mtl", box_mtl() + "newmtl pane\nillum 7\nNi 1.5\n");
  const auto warnings = info(scene)["warnings"];
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0].get<std::string>(), Contains("material pane") && Contains("3 edges"));
}

// Options that add lights, through the whole command.

/// A floor of 2 x 2 m and no light.
std::string write_floor(const FileFolder& folder) {
  folder.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  return folder.write("floor.obj",
                      "mtllib floor.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n"
                      "o floor\nusemtl grey\nf 4 3 2 1\n");
}

TEST_CASE("info lists a sun and a sky with their lumens") {
  const FileFolder folder;
  const Outcome outcome = succeed(
      {"info", write_floor(folder), "--json", "--sun", "180,45,50000", "--sky", "overcast=10000"});
  const auto facts = nlohmann::json::parse(outcome.output);
  REQUIRE(facts["lights"].size() == 3);
  CHECK(facts["lights"][2]["name"] == "ground");
  CHECK(facts["ground_reflectance"] == 0.2);
  CHECK(facts["lights"][0]["name"] == "sun");
  CHECK(facts["lights"][0]["kind"] == "sun");
  const double disc = 3.14159265358979 * 2;  // radius sqrt(2)
  CHECK(facts["lights"][0]["lumens"].get<double>() == Approx(50'000 * disc).epsilon(1e-4));
  CHECK(facts["lights"][1]["kind"] == "environment");
}

TEST_CASE("both integrators render a floor under a sky, as a layer that can be relit") {
  const FileFolder folder;
  const std::string integrator = GENERATE("photon-map", "path");
  const std::string picture = folder / "floor.exr";
  succeed(typed("render", write_floor(folder), "-o", picture,
                "--size 64x48 --samples 4 --integrator", integrator,
                "--quality draft --sky uniform=6830"));
  const Image image = read_image(picture);
  const auto* sky = image.find("Combined_sky.G");
  const auto* illuminance = image.find("Illuminance_sky.Y");
  REQUIRE(sky != nullptr);
  REQUIRE(illuminance != nullptr);
  // Somewhere the floor is seen, with 6830 lux, and somewhere the sky, with 10 / pi W/(m2 sr).
  float most = 0;
  for (const float lux : *illuminance) most = std::max(most, lux);
  CHECK(most == Approx(6830).epsilon(integrator == "path" ? 0.5 : 0.3));
  float brightest = 0;
  for (const float radiance : *sky) brightest = std::max(brightest, radiance);
  CHECK(brightest >= Approx(10 / 3.14159265).epsilon(0.01));
  succeed({"relight", picture, "--light", "sky=x2", "-o", folder / "twice.exr"});
}

TEST_CASE("a malformed option of a light is one line") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string lamp = folder.write("lamp.ies", "no lamp\n");
  const auto refused = [&](const std::vector<std::string>& options, int code, const char* words) {
    std::vector<std::string> arguments = typed("info", scene, options);
    CHECK_THAT(only_error(run_photile(arguments), code), Contains(words));
  };
  refused({"--sun", "1,2"}, 2, "AZIMUTH,ELEVATION,LUX");
  refused({"--sky", "foggy=1"}, 2, "uniform, overcast and clear");
  refused({"--sky", "clear=1000"}, 2, "needs a sun");
  refused({"--ies", "left"}, 2, "NAME=FILE");
  refused({"--ies", "left=" + lamp}, 2, "neither a point nor a spot light");
  refused({"--area-light", "Area=1x1"}, 2, "NAME=WxH,LUMENS");
  refused({"--area-light", "Area=1x1,100"}, 2, "glTF");
  refused({"--environment", folder / "gone.exr"}, 3, "gone.exr");
  refused({"--environment", lamp}, 3, "lamp.ies");
}

}  // namespace
}  // namespace photile::test
