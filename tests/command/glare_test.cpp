// Glare, luminaires and projections on the command line.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// Few photons and rays: seconds, not accuracy.
template <class... Parts>
std::vector<std::string> glare(const std::string& scene, const Parts&... more) {
  return typed("glare", scene,
               "--photons 20k --rays 64 --repeats 2 --samples 1 --quiet --picture-size 64",
               more...);
}

TEST_CASE("glare rates each observer and writes the same to all of its files") {
  const FileFolder folder;
  const std::string eyes = folder.write("eyes.pts", "# two\n0.2 0 0.1 0 1 0\n0 0 0 1 0 0\n");
  const Outcome outcome =
      succeed(glare(write_box(folder), "--observers", eyes, "-o", folder / "a.csv", "-o",
                    folder / "a.json", "--pictures", folder / "views"));
  CHECK_THAT(outcome.output, Contains("UGR") && Contains("DGP") && Contains("eyes 2"));
  const auto record = folder.json("a.json");
  REQUIRE(record["observers"].size() == 2);
  const auto& first = record["observers"][0];
  CHECK(first["name"] == "eyes 1");
  CHECK(first["illuminance"]["value"] > 0);
  CHECK(first["background_luminance"]["value"] > 0);
  const std::string csv = folder.read("a.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK_THAT(csv, Contains("observer,x,y,z") && Contains("eyes 1,0.2,0,0.1,0,1,0,"));
  for (const char* name : {"views/view-0001.hdr", "views/view-0002.hdr"}) {
    CHECK(read_image(folder / name).width == 64);
    CHECK_THAT(folder.read(name), Contains("VIEW= -vta") && Contains("-vh 180 -vv 180"));
  }
}

TEST_CASE("glare of lamps of next to no light has an error that is a number") {
  const FileFolder folder;
  const std::string eyes = folder.write("eyes.pts", "0.2 0 0.1 0 1 0\n");
  const Outcome outcome = succeed(
      glare(write_box(folder), "--observers", eyes, "--light left=1e-13 --light right=1e-13"));
  CHECK_THAT(outcome.output, !Contains("nan"));
}

TEST_CASE("a camera that is not in a room is told, with the remedy") {
  const FileFolder folder;
  const auto rate = [&](const std::string& scene) {
    return succeed(glare(scene, "--camera default --ratings ugr --sky uniform=1000")).errors;
  };
  CHECK_THAT(rate(folder.write("floor.obj", "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nf 4 3 2 1\n")),
             Contains("camera 'default' is not in a room") && Contains("--observers"));
  CHECK_THAT(rate(write_box(folder)), !Contains("is not in a room"));
}

TEST_CASE("a grid has four directions of view at each point, and no pictures") {
  const FileFolder folder;
  const Outcome outcome = succeed(glare(
      write_box(folder), "--grid floor+1.2 --spacing 0.5 --wall-band 0.2 -o", folder / "a.json"));
  const auto record = folder.json("a.json");
  const std::size_t views = record["observers"].size();
  CHECK(views >= 4);
  CHECK(views % 4 == 0);
  CHECK_FALSE(record["observers"][0].contains("picture"));
  CHECK_THAT(outcome.output, Contains("highest UGR") && !Contains("DGP"));
  // The same people beside lux, and what is required of them.
  const Outcome both = succeed(
      typed("measure", folder / "box.obj", "--photons 20k --rays 64 --repeats 2 --quiet",
            "--plane floor+0.75 --ugr-at floor+1.2 --spacing 0.5 --wall-band 0.2",
            "--maintenance 0.5 --target UGR=10 -o", folder / "b.json", "-o", folder / "b.html"));
  const auto measured = folder.json("b.json");
  CHECK(measured["glare"]["observers"] == record["observers"]);
  CHECK(measured["targets"][0]["judgements"][0]["figure"] == "UGR");
  CHECK_THAT(both.output, Contains("working plane, point ") && Contains("at most 10: NOT MET"));
  CHECK_THAT(folder.read("b.html"), Contains(">Glare (the worst") && Contains("the highest UGR"));
}

TEST_CASE("render projects as it is told, black beyond the circle of a fisheye") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string projection = GENERATE("angular", "fisheye", "equirectangular", "orthographic");
  // Parallel rays that start outside the box would see its dark outside.
  succeed(typed("render", scene, "--quality draft --photons 20k --samples 1 -q --projection",
                projection, "-o", folder / "a.exr", "-o", folder / "a.hdr",
                projection == "orthographic" ? "--field-of-view 0.5" : ""));
  const Image picture = read_image(folder / "a.exr");
  const bool round = projection == "angular" || projection == "fisheye";
  const bool sphere = projection == "equirectangular";
  CHECK(picture.height == 384);
  if (round) CHECK(picture.width == 384);
  if (sphere) CHECK(picture.width == 768);
  if (round) CHECK((*picture.find("G"))[0] == 0);
  const std::size_t middle = static_cast<std::size_t>(picture.width) * 192 + 100;
  CHECK((*picture.find("G"))[middle] > 0);
  CHECK((folder.read("a.hdr").find("VIEW=") == std::string::npos) == sphere);
}

TEST_CASE("a camera may be a view of Radiance: that of a picture shows the same again") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto render = [&](const std::string& name, const std::vector<std::string>& more) {
    succeed(typed("render", scene, "-o", folder / name,
                  "--photons 10k --size 24x24 --quality draft", more));
    return read_image(folder / name);
  };
  for (const std::string projection : {"perspective", "fisheye", "angular", "orthographic"}) {
    INFO(projection);
    const Image first = render("a.exr", {"--eye", "0.3,0.2,0.5", "--look-at", "0,-0.4,-1",
                                         "--projection", projection, "--field-of-view", "1.5"});
    const std::string view =
        folder.write("a.vf", "rvu " + first.attributes.at("photile.view") + "\n");
    const Image second = render("b.exr", {"--camera", view});
    for (std::size_t i = 0; i < first.pixels(); ++i) {
      REQUIRE((*second.find("G"))[i] == Approx((*first.find("G"))[i]).epsilon(1e-3));
    }
  }
}

TEST_CASE("ies says what a lamp is and prints its UGR table") {
  const FileFolder folder;
  const std::string file = folder.write(
      "lamp.ies",
      "IESNA:LM-63-2002\nTILT=NONE\n1 -1 0.001 4 1 1 2 0.1 1.2 0\n1 1 50\n0 30 60 90\n0\n"
      "300 250 120 0\n");
  const Outcome outcome =
      succeed({"ies", file, "--ugr-table", "-o", folder / "a.csv", "-o", folder / "a.json"});
  CHECK_THAT(outcome.output, Contains("1.2 m along azimuth 0 x 0.1 m along 90") &&
                                 Contains("crosswise") && Contains("12H x 8H"));
  const std::string csv = folder.read("a.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 20);
  CHECK(folder.json("a.json")["rooms"].size() == 19);
  // Ratings below 10 mean nothing; uncorrected values are none of a luminaire's.
  CHECK_THAT(outcome.output, Contains("   <10   <10"));
  CHECK_THAT(succeed({"ies", file, "--ugr-table", "--per-1000-lm"}).output, !Contains("<10"));
}

TEST_CASE("matt walls have no reflections to mark, with photons or paths") {
  const std::string integrator = GENERATE("photon-map", "path");
  const FileFolder folder;
  const Outcome outcome =
      succeed(typed("render", write_box(folder), "--size 40x30 --samples 1 --quality draft --glare",
                    folder / "glare.png", "--integrator", integrator));
  CHECK_THAT(outcome.errors, Contains("glare: no reflection is above"));
  CHECK(read_image(folder / "glare.png").width == 40);
}

}  // namespace
}  // namespace photile::test
