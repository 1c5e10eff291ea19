// `photile info` against what the written scene is known to hold.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

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
  const auto facts = nlohmann::json::parse(succeed(typed("info --json", scene, lamps)).output);
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

TEST_CASE("both integrators render a floor under a sky, as a layer that can be relit") {
  const FileFolder folder;
  const std::string integrator = GENERATE("photon-map", "path");
  const std::string picture = folder / "floor.exr";
  folder.write("floor.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n");
  succeed(typed("render", folder / "floor.obj", "-o", picture,
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
