// Options that add lights, through the whole command.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// A floor of 2 x 2 m and no light.
std::string write_floor(const FileFolder& folder) {
  folder.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  return folder.write("floor.obj",
                      "mtllib floor.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n"
                      "o floor\nusemtl grey\nf 4 3 2 1\n");
}

}  // namespace

TEST_CASE("info lists a sun and a sky with their lumens") {
  const FileFolder folder;
  const Outcome outcome = run_photile(
      {"info", write_floor(folder), "--json", "--sun", "180,45,50000", "--sky", "overcast=10000"});
  REQUIRE(outcome.exit_code == 0);
  const auto facts = nlohmann::json::parse(outcome.output);
  REQUIRE(facts["lights"].size() == 2);
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
  const Outcome outcome =
      run_photile({"render", write_floor(folder), "-o", picture, "--size", "64x48", "--samples",
                   "4", "--integrator", integrator, "--quality", "draft", "--sky", "uniform=6830"});
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
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
  CHECK(run_photile({"relight", picture, "--light", "sky=x2", "-o", folder / "twice.exr"})
            .exit_code == 0);
}

TEST_CASE("a malformed option of a light is one line") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string lamp = folder.write("lamp.ies", "no lamp\n");
  const auto refused = [&](const std::vector<std::string>& options, int code, const char* words) {
    std::vector<std::string> arguments{"info", scene};
    arguments.insert(arguments.end(), options.begin(), options.end());
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

}  // namespace photile::test
