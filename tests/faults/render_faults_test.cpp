// `photile render` where an OpenCL call fails: the same picture where memory ran out for a moment,
// else one message, the device exit code, and no picture.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <tuple>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

constexpr int success = 0;
constexpr int device_error = 4;

struct Failure {
  const char* call;
  int status;
  const char* name;
};

/// What renders are made with: the estimate at each hit, or at nodes that gather, which read
/// photons where their rays end.
enum class Light { estimated, gathered };

/// A small render with the failing layer set up by `layer`.
Run small_render(const FileFolder& folder, std::map<std::string, std::string> layer,
                 const std::vector<std::string>& options = {}, Light light = Light::estimated) {
  Run run;
  run.arguments = {"render", write_box(folder),  "--photons", "2000", "--size", "16x12",
                   "-o",     folder / "out.exr", "--quality"};
  run.arguments.emplace_back(light == Light::gathered ? "good" : "draft");
  run.arguments.insert(run.arguments.end(), options.begin(), options.end());
  run.environment = std::move(layer);
  run.environment["OPENCL_LAYERS"] = PHOTILE_FAILING_LAYER;
  return run;
}

/// The settings that make the `at`-th call fail, and if `on` all later ones; 0 only counts the
/// calls.
std::map<std::string, std::string> failing(const Failure& failure, long at, bool on,
                                           const FileFolder& folder, const char* device = "") {
  return {{"PHOTILE_DEVICE", device},
          {"PHOTILE_FAIL_CALL", failure.call},
          {"PHOTILE_FAIL_AT", std::to_string(at)},
          {"PHOTILE_FAIL_STATUS", std::to_string(failure.status)},
          {"PHOTILE_FAIL_ON", on ? "1" : "0"},
          {"PHOTILE_FAIL_COUNT_FILE", folder / "count"}};
}

/// How often an undisturbed render makes the call; each is counted once.
long count_calls(const Failure& failure, Light light, const char* device = "") {
  static std::map<std::tuple<std::string, Light, std::string>, long> counted;
  long& count = counted[{failure.call, light, device}];
  if (count > 0) return count;
  const FileFolder folder;
  const Outcome outcome =
      run_photile(small_render(folder, failing(failure, 0, false, folder, device), {}, light));
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == success);
  std::ifstream(folder / "count") >> count;
  REQUIRE(count > 0);
  return count;
}

/// The one message of a render whose `at`-th call fails.
void check_failure(const Failure& failure, Light light, long at, bool on, const char* device = "") {
  const FileFolder folder;
  const Outcome outcome =
      run_photile(small_render(folder, failing(failure, at, on, folder, device), {}, light));
  CAPTURE(failure.call, at, on);
  CHECK_THAT(last_error(outcome, device_error), Contains(failure.name));
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) {
    CHECK(entry.path().filename().string().find("out") == std::string::npos);
  }
}

/// All channels of a render that must succeed.
std::vector<std::vector<float>> picture_of(const FileFolder& folder, const Run& run) {
  const Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == success);
  return read_image(folder / "out.exr").channels;
}

const std::vector<std::vector<float>>& undisturbed_picture(Light light = Light::estimated) {
  static std::map<Light, std::vector<std::vector<float>>> pictures;
  auto& picture = pictures[light];
  if (picture.empty()) {
    const FileFolder folder;
    picture = picture_of(folder, small_render(folder, {}, {}, light));
  }
  return picture;
}

void check_same_picture(const Failure& failure, Light light, long at) {
  const FileFolder folder;
  CAPTURE(failure.call, failure.name, at);
  const Run run = small_render(folder, failing(failure, at, false, folder), {}, light);
  CHECK(picture_of(folder, run) == undisturbed_picture(light));
}

Failure out_of_memory() {
  return GENERATE(Failure{"clCreateBuffer", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                  Failure{"clEnqueueNDRangeKernel", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueNDRangeKernel", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                  Failure{"clEnqueueReadBuffer", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueWriteBuffer", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueFillBuffer", -6, "CL_OUT_OF_HOST_MEMORY"});
}

constexpr Failure other_failure{"clCreateKernel", -46, "CL_INVALID_KERNEL_NAME"};

}  // namespace

TEST_CASE("a render whose 1st, 2nd, 4th, 8th ... call of a kind runs out of memory is the same") {
  const Failure failure = out_of_memory();
  for (long at = 1, calls = count_calls(failure, Light::gathered); at <= calls; at *= 2) {
    check_same_picture(failure, Light::gathered, at);
  }
}

TEST_CASE("a render whose 1st, 2nd, 4th, 8th ... OpenCL call of a kind fails says so once") {
  for (long at = 1, calls = count_calls(other_failure, Light::gathered); at <= calls; at *= 2) {
    check_failure(other_failure, Light::gathered, at, false);
  }
}

TEST_CASE("a compiler without memory ends the command in one line, and not in a lock or a signal") {
  const FileFolder folder;
  auto layer = failing({"clBuildProgram", 0, ""}, 1, false, folder);
  layer["PHOTILE_FAIL_BY"] = GENERATE("new", "thread");
  CAPTURE(layer["PHOTILE_FAIL_BY"]);
  const Outcome outcome = run_photile(small_render(folder, layer, {"-q"}));
  CHECK_THAT(only_error(outcome, device_error), Contains("ulimit -v"));
}

TEST_CASE("a runtime that aborts ends the command in one line") {
  const FileFolder folder;
  auto layer = failing({"clBuildProgram", 0, ""}, 1, false, folder);
  layer["PHOTILE_FAIL_BY"] = "abort";
  const Outcome outcome = run_photile(small_render(folder, layer, {"-q"}));
  CHECK_THAT(only_error(outcome, device_error), Contains("--device"));
}

TEST_CASE("a compiler that takes more than a minute is told of once, and its kernel is run",
          "[slow]") {
  const FileFolder folder;
  auto layer = failing({"clBuildProgram", 0, ""}, 1, false, folder);
  layer["PHOTILE_FAIL_BY"] = "minute";
  const Outcome outcome = run_photile(small_render(folder, layer, {"-q"}));
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, Contains("for a minute") && Contains("-k"));
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
}

TEST_CASE("a device that is lost in the middle of a render is reported once") {
  const Failure failure = out_of_memory();
  const Light light = GENERATE(Light::estimated, Light::gathered);
  check_failure(failure, light, (count_calls(failure, light) + 1) / 2, true);
}

TEST_CASE("a call that fails on one of two devices ends the render on both, and is told once",
          "[slow]") {
  const char* const halves = "/2";
  const Light light = GENERATE(Light::estimated, Light::gathered);
  const Failure failure = out_of_memory();
  const long calls = count_calls(failure, light, halves);
  check_failure(failure, light, (calls + 1) / 2, true, halves);
  for (const bool on : {false, true}) {
    check_failure(other_failure, light, count_calls(other_failure, light, halves), on, halves);
  }
}

TEST_CASE("a device that allocates no large buffer renders the same picture from smaller ones") {
  // Positions of all photons take about 100 kB, estimates of all hits 18 kB.
  for (const char* const most : {"60000", "30000", "15000"}) {
    const FileFolder folder;
    CAPTURE(most);
    for (const Light light : {Light::estimated, Light::gathered}) {
      const Run run = small_render(folder, {{"PHOTILE_FAIL_ABOVE", most}}, {}, light);
      CHECK(picture_of(folder, run) == undisturbed_picture(light));
    }
  }
}

TEST_CASE("a device that allocates next to nothing is reported once") {
  const FileFolder folder;
  const Outcome outcome = run_photile(small_render(folder, {{"PHOTILE_FAIL_ABOVE", "100"}}));
  CHECK_THAT(last_error(outcome, device_error),
             Contains("CL_MEM_OBJECT_ALLOCATION_FAILURE") && Contains("use fewer photons"));
}

TEST_CASE("a render in a small device_memory is the same; in too small a one it says what to do") {
  const FileFolder folder;
  for (const char* const memory : {"device_memory=300e-6", "device_memory=150e-6"}) {
    CAPTURE(memory);
    CHECK(picture_of(folder, small_render(folder, {}, {"--set", memory})) == undisturbed_picture());
  }
  const Outcome outcome = run_photile(small_render(folder, {}, {"--set", "device_memory=3e-7"}));
  CHECK_THAT(last_error(outcome, device_error), Contains("a larger memory limit"));
}

TEST_CASE("PoCL with 256 MiB a buffer renders the same picture", "[slow]") {
  const FileFolder folder;
  // About 25 million stored photons: 300 MB of positions, more in the maps.
  const auto render_many = [&](std::map<std::string, std::string> environment) {
    Run run = small_render(folder, std::move(environment));
    run.arguments[3] = "8M";
    run.arguments.insert(run.arguments.end(), {"--set", "passes=1"});
    return picture_of(folder, run);
  };
  const auto expected = render_many({});
  CHECK(render_many({{"POCL_MEMORY_LIMIT", "1"}}) == expected);
}

TEST_CASE("a render in which any OpenCL call of a kind runs out of memory", "[slow]") {
  const Light light = GENERATE(Light::estimated, Light::gathered);
  const Failure failure = out_of_memory();
  const long calls = count_calls(failure, light);
  for (long at = 1; at <= calls; ++at) {
    check_same_picture(failure, light, at);
    check_failure(failure, light, at, true);
  }
}

}  // namespace photile::test
