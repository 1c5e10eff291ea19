// Every setting of the table is an option, in the records of a run, and in the documentation.
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

TEST_CASE("the documentation holds the table of settings as the command prints it") {
  const Outcome table = run_photile({"--settings-table"});
  REQUIRE(table.exit_code == 0);
  REQUIRE(std::count(table.output.begin(), table.output.end(), '\n') > 10);
  CHECK_THAT(content_of(source_folder() / "docs/command-line.md"), Contains(table.output));
}

TEST_CASE("every setting is an option of render, and in its help") {
  const Outcome help = run_photile({"render", "--help"});
  const Outcome measure = run_photile({"measure", "--help"});
  for (const Setting& setting : settings()) {
    if (setting.option.empty()) continue;
    CAPTURE(setting.name);
    CHECK_THAT(help.output, Contains(app::option_of(setting) + " "));
    const bool of_pictures = setting.name == "samples_per_pixel" || setting.name == "direct_rays" ||
                             setting.name == "gloss";
    CHECK((measure.output.find(app::option_of(setting) + " ") == std::string::npos) == of_pictures);
  }
}

TEST_CASE("a picture and its statistics tell every setting that it was made with") {
  const FileFolder folder;
  REQUIRE(run_photile(
              {"render",  write_box(folder), "-o",          folder / "a.exr", "--size",
               "16x12",   "--photons",       "5k",          "--quality",      "draft",
               "--quota", "equal",           "--structure", "kdtree-2d",      "--photons-per-cell",
               "0.1",     "--passes",        "3",           "--stats",        folder / "a.json"})
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
  CHECK(picture.attributes.at("photile.structure") == "kdtree-2d");
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
  CHECK(good["neighbours"] > draft["neighbours"]);
  CHECK(good["light_map_rays"] > 0);
  CHECK_THAT(only_error(run_photile({"render", write_box(folder), "-o", folder / "b.exr",
                                     "--quality", "best"}),
                        usage),
             Contains("draft, good, final"));
}

TEST_CASE("nodes gather in pictures unless another method is asked for") {
  const FileFolder folder;
  const auto [option, value, gather] =
      GENERATE(table<std::string, std::string, bool>({{"--direct", "rays", false},
                                                      {"--maps", "naive", false},
                                                      {"--light-maps", "off", false},
                                                      {"--passes", "2", false}}));
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
  CHECK_THAT(refusal({"--least-neighbours", "60", "-k", "50"}),
             Contains("--least-neighbours") && Contains("60") && Contains("50"));
  CHECK_THAT(refusal({"--maps", "naive", "--structure", "kdtree-global"}),
             Contains("--structure") && Contains("naive"));
  CHECK_THAT(refusal({"--direct", "photons", "--direct-rays", "2"}),
             Contains("--direct-rays") && Contains("--direct photons"));
}

}  // namespace photile::test
