// Measurements of the program's own: time against error, closed forms; and baked rooms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

// `photile trade`, and pictures made until one is good enough.

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_CASE("a trade writes its files and prints a row for each wanted error", "[slow]") {
  const FileFolder folder;
  const std::string results = folder / "results";
  const Outcome outcome =
      succeed(typed("trade", write_box(folder), "-o", results,
                    "--size 24x18 --photons 4k -k 8 --samples 1 --reference-samples 16 -q"));
  for (const char* error : {"10%", "5%", "2%", "1%"}) CHECK_THAT(outcome.output, Contains(error));

  const auto record = nlohmann::json::parse(text_of(results + "/trade.json"));
  CHECK(record["reference_samples"] == 16);
  CHECK(record["reference_relative_mse"] > 0);
  const std::size_t renderings = record["renderings"].size();
  CHECK(renderings > 20);
  CHECK(lines_of(text_of(results + "/trade.csv")) == renderings + 1);  // and a header
  CHECK_FALSE(text_of(results + "/reference.exr").empty());

  // The reference that it wrote is one that it reads, and then traces none.
  const Outcome again = succeed(typed("trade", folder / "box.obj", "-o", folder / "again",
                                      "--size 24x18 --photons 4k -k 8 --samples 1 --reference",
                                      results + "/reference.exr", "-q"));
  CHECK(text_of(folder / "again/reference.exr").empty());
}

TEST_CASE("a trade refuses a reference of another size in one line") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string reference = folder / "reference.exr";
  succeed(typed("render", scene, "--integrator path --size 16x16 --samples 1 -o", reference, "-q"));
  const std::string line =
      only_error(run_photile({"trade", scene, "-o", folder / "results", "--reference", reference,
                              "--size", "24x18", "-q"}),
                 2);
  CHECK_THAT(line, Contains("16x16") && Contains("--size"));
}

TEST_CASE("pictures are made until one states the wanted error, which its settings make again") {
  const FileFolder folder;
  const std::vector<std::string> box{"render", write_box(folder), "--size", "24x18"};
  const auto photile = [&](std::vector<std::string> more) {
    more.insert(more.begin(), box.begin(), box.end());
    const Outcome outcome = succeed(more);
    return outcome;
  };
  const Outcome outcome =
      photile({"-o", folder / "box.exr", "--set", "light_map_rays=8", "--photons", "20k",
               "--samples", "2", "--target-error", "0.9%", "--stats", folder / "box.json"});
  CHECK_THAT(outcome.errors, Contains("picture 1: standard error") && Contains("picture 2: "));
  const auto record = nlohmann::json::parse(text_of(folder / "box.json"));
  const auto maps = std::find_if(record["stages"].begin(), record["stages"].end(),
                                 [](const auto& s) { return s["stage"] == "light maps"; });
  REQUIRE(maps != record["stages"].end());
  CHECK((*maps)["figures"]["standard error percent"] <= 0.9);
  CHECK(record["asked"]["target_error"].get<double>() == Approx(0.009));

  const auto& used = record["parameters"];
  CHECK(used["light_map_rays"] > 8);
  photile({"-o", folder / "again.exr", "--set", "light_map_rays=" + used["light_map_rays"].dump(),
           "--photons", used["photons_emitted"].dump(), "--samples",
           used["samples_per_pixel"].dump(), "-q"});
  const Image made = read_image(folder / "box.exr"), again = read_image(folder / "again.exr");
  CHECK(made.channels == again.channels);
}

TEST_CASE("an error that is out of reach is told") {
  const FileFolder folder;
  const Outcome outcome = succeed(typed("render", write_box(folder), "-o", folder / "box.exr",
                                        "--size 24x18 --target-error 0.001% --for 1ms"));
  CHECK_THAT(outcome.errors, Contains("warning: a standard error of 0.001% was not reached"));
}

TEST_CASE("pictures are made for a time; that needs nodes that gather") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const Outcome outcome =
      succeed({"render", scene, "-o", folder / "box.exr", "--size", "24x18", "--for", "1ms"});
  CHECK_THAT(outcome.errors,
             Contains("picture 1: ") &&
                 Contains("--photons 125000 -k 100 --samples 4 --set light_map_rays=16") &&
                 !Contains("picture 2"));
  CHECK_FALSE(text_of(folder / "box.exr").empty());
  const std::string goal = GENERATE("--for=1s", "--target-error=2%");
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = typed("render", scene, "-o", folder / "no.exr", goal, more);
    return only_error(run_photile(all), 2);
  };
  const std::string name = goal.substr(0, goal.find('='));
  CHECK_THAT(refused({"--set", "light_maps=off"}), Contains(name) && Contains("--quality good"));
  CHECK_THAT(refused({"--quality", "draft"}), Contains(name) && Contains("--quality good"));
  CHECK_THAT(refused({"--integrator", "path"}), Contains(name));
  CHECK_THAT(refused({"--glare", folder / "glare.png"}), Contains(name));
}

TEST_CASE("wanted errors and times that are none are usage errors") {
  const FileFolder folder;
  const std::string option =
      GENERATE("--target-error=0", "--target-error=200%", "--target-error=small", "--for=33",
               "--for=-1s", "--for=fast");
  INFO(option);
  only_error(run_photile({"render", write_box(folder), "-o", folder / "box.exr", option}), 2);
}

// `photile validate`: the table, the JSON and the exit codes.

TEST_CASE("validate prints expected, measured and error, and says the same in JSON") {
  const FileFolder folder;
  const Outcome outcome = succeed({"validate", "--case", "point light", "--integrator", "path",
                                   "--paths", "100", "--json", folder / "readings.json"});
  CHECK_THAT(outcome.output, Contains("expected") && Contains("point light over a surface") &&
                                 Contains("below the lamp") && Contains("ok"));
  const auto record = nlohmann::json::parse(folder.read("readings.json"));
  CHECK(record["seeds"] == 16);
  REQUIRE(record["readings"].size() == 4);
  for (const auto& reading : record["readings"]) {
    CHECK(reading["unit"] == "lx");
    CHECK(reading["path"]["verdict"] == "ok");
    CHECK(reading["path"]["value"] == Approx(reading["expected"].get<double>()).epsilon(0.001));
    CHECK_FALSE(reading.contains("photon_map"));
  }
}

TEST_CASE("readings that are too noisy for 1% make validate fail") {
  const Outcome outcome = run_photile(
      {"validate", "--case", "opposed", "--photons", "1000", "-k", "5", "--paths", "1", "--quiet"});
  CHECK(outcome.exit_code == 1);
  CHECK_THAT(outcome.output, Contains("too noisy"));
  CHECK_THAT(last_error(outcome, 1), Contains("1 of 1 readings") && Contains("--photons"));
}

TEST_CASE("an unknown case is a usage error that lists those there are") {
  CHECK_THAT(only_error(run_photile({"validate", "--case", "moonlight"}), 2),
             Contains("moonlight") && Contains("integrating sphere"));
}

// `photile bake`: the files that it writes, and what other programs find in them.

std::vector<std::string> bake(const FileFolder& folder, const std::vector<std::string>& more = {}) {
  return typed("bake", write_box(folder), "-o", folder / "baked.gltf", "--photons 50k", more);
}

TEST_CASE("a baked scene has a second set of coordinates and a picture for each light") {
  const FileFolder folder;
  succeed(bake(folder));
  const nlohmann::json document = nlohmann::json::parse(folder.read("baked.gltf"));
  const auto& primitive = document["meshes"][0]["primitives"][0];
  const auto& lights = document["accessors"][primitive["attributes"]["TEXCOORD_1"].get<int>()];
  CHECK(lights["type"] == "VEC2");
  CHECK(lights["count"] ==
        document["accessors"][primitive["attributes"]["POSITION"].get<int>()]["count"]);
  for (const int axis : {0, 1}) {
    CHECK(lights["min"][axis] >= 0.0);
    CHECK(lights["max"][axis] <= 1.0);
  }
  const auto& maps = document["scenes"][0]["extras"]["photile"]["light_maps"];
  REQUIRE(maps.size() == 2);
  for (const auto& map : maps) {
    const Image picture = read_image(folder / map["uri"].get<std::string>());
    CHECK(picture.attributes.at("photile.light") == map["light"].get<std::string>());
    const std::vector<float>& green = *picture.find("G");
    CHECK(*std::max_element(green.begin(), green.end()) > 0);
    CHECK(*std::min_element(green.begin(), green.end()) >= 0);
  }
  CHECK(std::filesystem::file_size(folder / "baked.bin") ==
        document["buffers"][0]["byteLength"].get<std::size_t>());
}

TEST_CASE("bake refuses what it cannot do in one line") {
  const FileFolder folder;
  CHECK_THAT(only_error(run_photile({"bake", write_box(folder), "-o", folder / "a.glb"}), 2),
             Contains(".gltf"));
  CHECK_THAT(last_error(run_photile(bake(folder, {"--texel", "0.00001"})), 2),
             Contains("do not fit"));
  CHECK_THAT(only_error(run_photile(bake(folder, {"--texel", "0"})), 2), Contains("--texel"));
}

}  // namespace
}  // namespace photile::test
