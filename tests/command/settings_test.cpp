// Every setting of the table is an option or reached by --set, in the records of a run, and in the
// documentation.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "command/setting_options.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("the documentation holds the tables of settings as the command prints them") {
  const Outcome tables = run_photile({"settings", "--markdown"});
  REQUIRE(tables.exit_code == 0);
  const std::size_t blank = tables.output.find("\n\n");
  const std::string all = tables.output.substr(0, blank), qualities = tables.output.substr(blank);
  REQUIRE(std::count(all.begin(), all.end(), '\n') > 10);
  REQUIRE(std::count(qualities.begin(), qualities.end(), '\n') > 5);
  CHECK_THAT(content_of(source_folder() / "docs/settings.md"), Contains(all));
  CHECK_THAT(content_of(source_folder() / "docs/command-line.md"), Contains(qualities));
}

TEST_CASE("every setting is an option of render, or one that --set reaches") {
  const Outcome help = run_photile({"render", "--help"}), list = run_photile({"settings"});
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    if (setting.option.empty()) {
      CHECK_THAT(list.output, Contains("  " + std::string(setting.name) + " "));
    } else {
      CHECK_THAT(help.output, Contains(app::option_of(setting) + " "));
    }
  }
}

TEST_CASE("the help of render has at most 45 options") {
  std::istringstream help(run_photile({"render", "--help"}).output);
  int options = 0;
  for (std::string line; std::getline(help, line);) options += line.starts_with("  -") ? 1 : 0;
  CHECK(options > 30);
  CHECK(options <= 45);
}

TEST_CASE("what --set does not know is refused in a line that says what to type") {
  const auto [command, arguments, remedy] =
      GENERATE(table<std::string, std::vector<std::string>, std::string>({
          {"render", {"--set", "light_map_ray=64"}, "nearest is light_map_rays"},
          {"render", {"--set", "Radius=1"}, "nearest is radius"},
          {"render", {"--set", "radius"}, "radius=X"},
          {"render", {"--set", "maps="}, "naive"},
          {"render", {"--set", ""}, "empty"},
          {"render", {"--set", "samples_per_pixel=4"}, "--samples"},
          {"render", {"--set", "width=4"}, "--size"},
          {"measure", {"--set", "gloss=rays"}, "no use"},
          {"render", {"--radius", "0.1"}, "--set radius=0.1"},
          {"render", {"--angle=30"}, "--set angle_degrees=30"},
          {"render", {"--light-map-rays", "64"}, "--set light_map_rays=64"},
          {"walk", {"--lambertian"}, "--set lambertian="},
      }));
  const FileFolder folder;
  const std::string output = command == "measure" ? "out.csv" : "out.exr";
  std::vector<std::string> all{command, write_box(folder), "-o", folder / output};
  all.insert(all.end(), arguments.begin(), arguments.end());
  CAPTURE(all);
  CHECK_THAT(only_error(run_photile(all), usage), Contains(remedy));
}

TEST_CASE("settings of scenes and devices are set by name, too") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto radiance = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "--size", "8x6", "--photons", "5k", "--quality",
                               "draft", "-o", folder / name, "-q"});
    REQUIRE(run_photile(more).exit_code == 0);
    return *read_image(folder / name).find("R");
  };
  const auto usual = radiance("a.exr", {});
  const auto twice = radiance("b.exr", {"--set", "emissive_scale=2", "--set", "device_memory=1",
                                        "--set", "program_cache=off"});
  for (std::size_t i = 0; i < usual.size(); ++i) CHECK(twice[i] == Approx(2 * usual[i]));
}

TEST_CASE("a picture and its statistics tell every setting that it was made with") {
  const FileFolder folder;
  REQUIRE(run_photile({"render", write_box(folder), "-o", folder / "a.exr", "--size", "16x12",
                       "--photons", "5k", "--quality", "draft", "--set", "quota=equal", "--set",
                       "photons_per_cell=0.1", "--set", "passes=3", "--stats", folder / "a.json"})
              .exit_code == 0);
  const Image picture = read_image(folder / "a.exr");
  const auto recorded = nlohmann::json::parse(folder.read("a.json"))["parameters"];
  for (const Setting& setting : settings()) {
    const std::string name(setting.name);
    CAPTURE(name);
    CHECK(recorded.contains(name));
    CHECK(picture.attributes.count("photile." + name) == 1);
  }
  CHECK(picture.attributes.at("photile.quality") == "draft");
  CHECK(picture.attributes.at("photile.quota") == "equal");
  CHECK(picture.attributes.at("photile.photons_per_cell") == "0.1");
  CHECK(recorded["photons_emitted"] == 5000);
  CHECK(recorded["samples_per_pixel"] == 6);  // a multiple of the passes
  CHECK(recorded["passes"] == 3);
  CHECK(recorded["radius"] > 0);  // the one used
}

TEST_CASE("--quality sets settings that go together, and those given beside it count") {
  const FileFolder folder;
  const auto made_with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "render", write_box(folder), "-o", folder / "a.exr", "--size",
        "8x6",    "--photons",       "5k", "--stats",        folder / "a.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    REQUIRE(run_photile(arguments).exit_code == 0);
    const auto record = nlohmann::json::parse(folder.read("a.json"));
    CHECK(record["asked"]["quality"] == (more.front() == "--quality" ? more[1] : "good"));
    return record["parameters"];
  };
  const nlohmann::json draft = made_with({"--quality", "draft"});
  // Photons come before the quality on the line, samples after it.
  const nlohmann::json good = made_with({"--quality", "good", "--samples", "2"});
  CHECK(good["photons_emitted"] == 5000);
  CHECK(good["samples_per_pixel"] == 2);
  CHECK(good["light_maps"] == "on");
  CHECK(good == made_with({"--samples", "2"}));  // the usual quality
  CHECK(good["neighbours"] < draft["neighbours"]);  // nodes average over rays, not over photons
  CHECK(good["light_map_rays"] > 0);
  CHECK_THAT(only_error(run_photile({"render", write_box(folder), "-o", folder / "b.exr",
                                     "--quality", "best"}),
                        usage),
             Contains("draft, good, final"));
}

TEST_CASE("nodes gather in pictures unless another method is asked for") {
  const FileFolder folder;
  const auto [option, value, gather] =
      GENERATE(table<std::string, std::string, bool>({{"--set", "direct_rays=1", false},
                                                      {"--set", "maps=naive", false},
                                                      {"--set", "light_maps=off", false},
                                                      {"--set", "passes=2", false}}));
  CAPTURE(option);
  REQUIRE(run_photile({"render", write_box(folder), "-o", folder / "a.exr", "--size", "8x6",
                       "--photons", "5k", "-k", "50", "--samples", "2", option, value, "--stats",
                       folder / "a.json"})
              .exit_code == 0);
  const auto used = nlohmann::json::parse(folder.read("a.json"))["parameters"];
  CHECK((used["light_map_rays"] > 0) == gather);
}

TEST_CASE("settings that go with no other are refused by the names of their options") {
  const FileFolder folder;
  const auto refusal = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", write_box(folder), "-o", folder / "out.exr"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return only_error(run_photile(arguments), usage);
  };
  CHECK_THAT(refusal({"--set", "least_neighbours=60", "-k", "50"}),
             Contains("least_neighbours") && Contains("60") && Contains("50"));
}

}  // namespace photile::test
