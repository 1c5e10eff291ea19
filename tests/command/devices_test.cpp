// `photile devices` and the choice of a device.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_bytes.hpp"
#include "file_folder.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// `run` where the OpenCL loader finds no platform.
Run without_platforms(const FileFolder& folder, std::vector<std::string> arguments) {
  std::filesystem::create_directory(folder / "vendors");
  Run run;
  run.arguments = std::move(arguments);
  run.environment["OCL_ICD_VENDORS"] = folder / "vendors/";
  return run;
}

}  // namespace

TEST_CASE("the list of devices is JSON and marks exactly one as selected") {
  const Outcome outcome = run_photile({"devices", "--json"});
  REQUIRE(outcome.exit_code == 0);
  const auto devices = nlohmann::json::parse(outcome.output);
  REQUIRE(devices.size() >= 1);
  CHECK(std::count_if(devices.begin(), devices.end(),
                      [](const auto& device) { return device["selected"] == true; }) == 1);
  for (const auto& device : devices) {
    CHECK(device["max_allocation_bytes"] <= device["global_memory_bytes"]);
  }
}

TEST_CASE("the list of devices has a line for each and marks the selected one with a star") {
  const auto count = nlohmann::json::parse(run_photile({"devices", "--json"}).output).size();
  const Outcome outcome = run_photile({"devices"});
  REQUIRE(outcome.exit_code == 0);
  CHECK(static_cast<std::size_t>(std::count(outcome.output.begin(), outcome.output.end(), '\n')) ==
        count + 1);
  CHECK_THAT(outcome.output, Contains("* 0:0"));
}

TEST_CASE("without any OpenCL platform every command that needs one says so and exits with 4") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"devices"}, {"devices", "--json"}, {"render", scene, "-o", folder / "out.exr"}}) {
    only_error(run_photile(without_platforms(folder, arguments)), no_device);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_CASE("what needs no device works without any OpenCL platform") {
  const FileFolder folder;
  CHECK(run_photile(without_platforms(folder, {"info", write_box(folder)})).exit_code == 0);
}

TEST_CASE("an unknown device is refused with the list of those there are") {
  const FileFolder folder;
  const Outcome outcome = run_photile(
      {"render", write_box(folder), "-o", folder / "out.exr", "--device", "no-such-device"});
  CHECK_THAT(only_error(outcome, no_device), Contains("no-such-device") && Contains("0:0"));
}

TEST_CASE("compiling as JSON is refused") {
  CHECK_THAT(only_error(run_photile({"devices", "--compile", "--json"}), usage),
             Contains("--json") && Contains("--compile"));
}

TEST_CASE("after devices --compile the first picture of an interior compiles nothing", "[slow]") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "cache");
  Run run;
  run.environment["XDG_CACHE_HOME"] = folder / "cache";
  run.arguments = {"devices", "--compile"};
  const Outcome compiled = run_photile(run);
  INFO(compiled.errors);
  REQUIRE(compiled.exit_code == 0);
  CHECK_THAT(compiled.errors, Contains(" compiled, ") && !Contains(": 0 compiled"));
  const std::string room = source_folder() / "scenes/living-room/living-room.gltf";
  run.arguments = {"render",    room,   "-o",     folder / "out.png",
                   "--photons", "200k", "--size", "16x12"};
  const Outcome rendered = run_photile(run);
  REQUIRE(rendered.exit_code == 0);
  CHECK_THAT(rendered.errors, Contains(": 0 compiled"));
}

TEST_CASE("two halves of a device render the file of the whole, and the record names both") {
  const FileFolder folder;
  Run run;
  run.arguments = {"render", write_box(folder), "-o",    folder / "whole.png", "--photons",
                   "5k",     "--size",          "64x48", "--quality",          "draft"};
  REQUIRE(run_photile(run).exit_code == 0);
  run.arguments[3] = folder / "halves.png";
  run.arguments.insert(run.arguments.end(), {"--stats", folder / "stats.json"});
  run.environment["PHOTILE_DEVICE"] = "0:0/2";
  const Outcome outcome = run_photile(run);
  REQUIRE(outcome.exit_code == 0);
  CHECK(folder.read("halves.png") == folder.read("whole.png"));
  CHECK_THAT(outcome.errors, Contains("device: 0:0.0 ") && Contains("device: 0:0.1 ") &&
                                 Contains("share of 0:0.0") && Contains("share of 0:0.1"));
  const auto devices = nlohmann::json::parse(folder.read("stats.json"))["devices"];
  REQUIRE(devices.size() == 2);
  CHECK(devices[0]["id"] == "0:0.0");
  CHECK(devices[1]["id"] == "0:0.1");
  CHECK(devices[0]["share"].get<double>() + devices[1]["share"].get<double>() == Approx(1));
}

TEST_CASE("the list of devices marks the whole of which parts are chosen") {
  const Outcome outcome = run_photile({"devices", "--device", "0:0/2"});
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Contains("* 0:0 "));
}

TEST_CASE("PHOTILE_DEVICE chooses the device where --device does not") {
  Run run;
  run.arguments = {"devices"};
  run.environment["PHOTILE_DEVICE"] = "no-such-device";
  CHECK_THAT(only_error(run_photile(run), no_device), Contains("no-such-device"));
  run.arguments = {"devices", "--device", "0:0"};
  CHECK(run_photile(run).exit_code == 0);
}

TEST_CASE("the test of devices passes, and not with kernels that compute wrong areas", "[slow]") {
  const FileFolder folder;
  Run run;
  run.arguments = {"devices", "--test"};
  const Outcome right = run_photile(run);
  CHECK(right.exit_code == 0);
  CHECK_THAT(right.output, Contains("passed ("));

  const auto file = std::filesystem::path("surface/clipped_disc.clh");
  std::string text = bytes_of(source_folder() / "kernels" / file);
  const std::string area = "disc->area = squared_radius";
  REQUIRE(text.find(area) != std::string::npos);
  text.insert(text.find(area) + std::string("disc->area = ").size(), "1.01f * ");
  std::filesystem::create_directories(folder / "kernels/surface");
  std::ofstream(folder / "kernels/surface/clipped_disc.clh") << text;
  run.environment["PHOTILE_KERNEL_DIR"] = folder / "kernels";
  const Outcome wrong = run_photile(run);
  CHECK_THAT(wrong.output, Contains("not passed: the irradiance of hit"));
  CHECK_THAT(last_error(wrong, no_device), Contains("computes wrong results"));
}

}  // namespace photile::test
