// `photile trade`, and pictures made until one is good enough.
#include <catch2/catch.hpp>
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

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("a trade writes its files and prints a row for each wanted error", "[slow]") {
  const FileFolder folder;
  const std::string results = folder / "results";
  const Outcome outcome =
      run_photile({"trade", write_box(folder), "-o", results, "--size", "24x18", "--photons", "4k",
                   "-k", "8", "--samples", "1", "--reference-samples", "16", "-q"});
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  for (const char* error : {"10%", "5%", "2%", "1%"}) CHECK_THAT(outcome.output, Contains(error));

  const auto record = nlohmann::json::parse(text_of(results + "/trade.json"));
  CHECK(record["reference_samples"] == 16);
  CHECK(record["reference_relative_mse"] > 0);
  const std::size_t renderings = record["renderings"].size();
  CHECK(renderings > 20);
  CHECK(lines_of(text_of(results + "/trade.csv")) == renderings + 1);  // and a header
  CHECK_FALSE(text_of(results + "/reference.exr").empty());

  // The reference that it wrote is one that it reads, and then traces none.
  const Outcome again = run_photile({"trade", folder / "box.obj", "-o", folder / "again", "--size",
                                     "24x18", "--photons", "4k", "-k", "8", "--samples", "1",
                                     "--reference", results + "/reference.exr", "-q"});
  CHECK(again.exit_code == 0);
  CHECK(text_of(folder / "again/reference.exr").empty());
}

TEST_CASE("a trade refuses a reference of another size in one line") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const std::string reference = folder / "reference.exr";
  REQUIRE(run_photile({"render", scene, "--integrator", "path", "--size", "16x16", "--samples", "1",
                       "-o", reference, "-q"})
              .exit_code == 0);
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
    const Outcome outcome = run_photile(more);
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
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
  const Outcome outcome =
      run_photile({"render", write_box(folder), "-o", folder / "box.exr", "--size", "24x18",
                   "--target-error", "0.001%", "--for", "1ms"});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("warning: a standard error of 0.001% was not reached"));
}

TEST_CASE("pictures are made for a time; that needs nodes that gather") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const Outcome outcome =
      run_photile({"render", scene, "-o", folder / "box.exr", "--size", "24x18", "--for", "1ms"});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors,
             Contains("picture 1: ") &&
                 Contains("--photons 125000 -k 100 --samples 4 --set light_map_rays=16") &&
                 !Contains("picture 2"));
  CHECK_FALSE(text_of(folder / "box.exr").empty());
  const std::string goal = GENERATE("--for=1s", "--target-error=2%");
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"render", scene, "-o", folder / "no.exr", goal};
    all.insert(all.end(), more.begin(), more.end());
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

}  // namespace photile::test
