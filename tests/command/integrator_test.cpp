// `photile render --integrator path`: the same files as photon maps give, without their options.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::vector<std::string> by_paths(const FileFolder& folder,
                                  const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"render", write_box(folder), "--integrator",
                                     "path",   "--size",          "16x12"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

}  // namespace

TEST_CASE("paths need no OpenCL device and give layers that can be relit") {
  const FileFolder folder;
  Run run;
  run.arguments = by_paths(folder, {"-o", folder / "a.exr", "--stats", folder / "a.json"});
  run.environment["OCL_ICD_VENDORS"] = folder / "no runtimes";
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);

  const Image picture = read_image(folder / "a.exr");
  CHECK(picture.find("Combined_left.R") != nullptr);
  CHECK(picture.find("Illuminance_right.Y") != nullptr);
  CHECK(picture.attributes.at("photile.integrator") == "path");
  CHECK(picture.attributes.count("photile.photons_emitted") == 0);
  CHECK(picture.attributes.count("photile.device") == 0);
  const auto statistics = nlohmann::json::parse(folder.read("a.json"));
  CHECK(statistics["parameters"]["integrator"] == "path");
  CHECK_FALSE(statistics.contains("photons_stored"));

  REQUIRE(run_photile({"relight", folder / "a.exr", "--light", "left=off", "-o", folder / "b.exr"})
              .exit_code == 0);
  CHECK(*read_image(folder / "b.exr").find("R") == *picture.find("Combined_right.R"));
}

TEST_CASE("options of photon maps are usage errors beside --integrator path") {
  const auto option = GENERATE(values<std::vector<std::string>>({{"--photons", "10"},
                                                                 {"--set", "passes=2"},
                                                                 {"--set", "quota=power"},
                                                                 {"-k", "20"},
                                                                 {"--set", "radius=0.1"},
                                                                 {"--set", "angle_degrees=30"},
                                                                 {"--set", "maps=auto"},
                                                                 {"--set", "photons_per_cell=2"},
                                                                 {"--device", "cpu"},
                                                                 {"--set", "device_memory=1"},
                                                                 {"--set", "program_cache=off"},
                                                                 {"--set", "profile=on"}}));
  const FileFolder folder;
  std::vector<std::string> options{"-o", folder / "a.exr"};
  options.insert(options.end(), option.begin(), option.end());
  const std::string name = option[0] == "-k" ? "--neighbours" : option[0];
  CHECK_THAT(only_error(run_photile(by_paths(folder, options)), 2),
             Contains(name) && Contains("photon maps"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_CASE("a signal stops paths with 130") {
  const FileFolder folder;
  Run run;
  run.arguments = by_paths(folder, {"-o", folder / "out.exr", "--samples", "65536"});
  run.terminal = true;
  run.signal_when = "%  ";  // only a bar under way prints one
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 130);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace photile::test
