// `photile trade`, and settings chosen by `photile render`.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"

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

TEST_CASE("a render for a wanted error tells its choice and what it expects") {
  const FileFolder folder;
  const Outcome outcome =
      run_photile({"render", write_box(folder), "-o", folder / "box.exr", "--size", "48x36",
                   "--quality", "draft", "--target-error", "20%", "--stats", folder / "box.json"});
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("chosen: --photons") && Contains("expected: error"));
  const auto record = nlohmann::json::parse(text_of(folder / "box.json"));
  const auto stage = std::find_if(record["stages"].begin(), record["stages"].end(),
                                  [](const auto& s) { return s["stage"] == "choose settings"; });
  REQUIRE(stage != record["stages"].end());
  CHECK((*stage)["figures"]["expected relative error"] <= 0.2);
}

TEST_CASE("a time budget that nothing meets is told, and the fastest settings are used") {
  const FileFolder folder;
  const Outcome outcome = run_photile({"render", write_box(folder), "-o", folder / "box.exr",
                                       "--size", "48x36", "--time-budget", "0.000001ms"});
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("warning: frames of") && Contains("--samples 1"));
}

TEST_CASE("pictures are made until one states the wanted error, and are there meanwhile") {
  const FileFolder folder;
  const Outcome outcome = run_photile({"render", write_box(folder), "-o", folder / "box.exr",
                                       "--size", "24x18", "--light-map-rays", "8", "--target-error",
                                       "2%", "--stats", folder / "box.json"});
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("picture 1: ") && Contains("rays a node, standard error"));
  const auto record = nlohmann::json::parse(text_of(folder / "box.json"));
  const auto maps = std::find_if(record["stages"].begin(), record["stages"].end(),
                                 [](const auto& s) { return s["stage"] == "light maps"; });
  REQUIRE(maps != record["stages"].end());
  CHECK((*maps)["figures"]["standard error percent"] <= 2.0);
  CHECK(record["asked"]["target_error"] == 0.02);
}

TEST_CASE("pictures are made for a time; that needs nodes that gather") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const Outcome outcome =
      run_photile({"render", scene, "-o", folder / "box.exr", "--size", "24x18", "--for", "1ms"});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors,
             Contains("picture 1: 125000 photons, 16 rays") && !Contains("picture 2"));
  CHECK_FALSE(text_of(folder / "box.exr").empty());
  const std::string refused = only_error(
      run_photile({"render", scene, "-o", folder / "no.exr", "--for", "1s", "--light-maps", "off"}),
      2);
  CHECK_THAT(refused, Contains("--for") && Contains("--quality good"));
  only_error(run_photile({"render", scene, "-o", folder / "no.exr", "--for", "1s", "--glare",
                          folder / "glare.png"}),
             2);
}

TEST_CASE("settings that are chosen cannot be given, too") {
  const FileFolder folder;
  const auto [wish, option] = GENERATE(table<std::string, std::string>({
      {"--target-error=2%", "--photons=1M"},
      {"--target-error=2%", "--neighbours=50"},
      {"--time-budget=1s", "--samples=4"},
      {"--time-budget=1s", "--radius=0.1"},
      {"--time-budget=1s", "--quality=good"},
      {"--time-budget=1s", "--for=1s"},
  }));
  INFO(wish << " " << option);
  only_error(run_photile({"render", write_box(folder), "-o", folder / "box.exr", wish, option}), 2);
}

TEST_CASE("wanted errors and times that are none are usage errors") {
  const FileFolder folder;
  const std::string option =
      GENERATE("--target-error=0", "--target-error=200%", "--target-error=small",
               "--time-budget=33", "--time-budget=-1s", "--time-budget=fast");
  INFO(option);
  only_error(run_photile({"render", write_box(folder), "-o", folder / "box.exr", option}), 2);
}

}  // namespace photile::test
