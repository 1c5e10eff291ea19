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
  const auto facts = info(scene, {"--light-group", "*t=both"});
  CHECK(facts["lights"][0]["group"] == "both");
  REQUIRE(facts["groups"].size() == 1);
  CHECK(facts["groups"][0]["name"] == "both");
  CHECK(facts["groups"][0]["lights"] == nlohmann::json{"left", "right"});
  const auto watts = [](const nlohmann::json& light) { return light["watts"].get<double>(); };
  CHECK(watts(facts["groups"][0]) ==
        Approx(watts(facts["lights"][0]) + watts(facts["lights"][1])).epsilon(1e-12));
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

}  // namespace
}  // namespace photile::test
