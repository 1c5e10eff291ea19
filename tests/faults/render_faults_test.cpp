// `photile render` where an OpenCL call fails: one message, the device exit code, and no picture.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {
namespace {

constexpr int success = 0;
constexpr int device_error = 4;

struct Failure {
  const char* call;
  int status;
  const char* name;
};

/// A small render under the failing layer; `at` 0 only counts the calls.
Run render_with(const FileFolder& folder, const Failure& failure, long at, bool on,
                const char* device = "") {
  Run run;
  run.arguments = {"render", folder / "box.obj", "--photons", "2000", "--size", "16x12",
                   "-o",     folder / "out.exr"};
  run.environment = {{"PHOTILE_DEVICE", device},
                     {"OPENCL_LAYERS", PHOTILE_FAILING_LAYER},
                     {"PHOTILE_FAIL_CALL", failure.call},
                     {"PHOTILE_FAIL_AT", std::to_string(at)},
                     {"PHOTILE_FAIL_STATUS", std::to_string(failure.status)},
                     {"PHOTILE_FAIL_ON", on ? "1" : "0"},
                     {"PHOTILE_FAIL_COUNT_FILE", folder / "count"}};
  return run;
}

long count_calls(const Failure& failure, const char* device = "") {
  const FileFolder folder;
  write_box(folder);
  const Outcome outcome = run_photile(render_with(folder, failure, 0, false, device));
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == success);
  long count = 0;
  std::ifstream(folder / "count") >> count;
  REQUIRE(count > 0);
  return count;
}

/// The one message of a render whose `at`-th call fails.
void check_failure(const Failure& failure, long at, bool on, const char* device = "") {
  const FileFolder folder;
  write_box(folder);
  const Outcome outcome = run_photile(render_with(folder, failure, at, on, device));
  CAPTURE(failure.call, at, on);
  CHECK_THAT(last_error(outcome, device_error), Catch::Contains(failure.name));
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) {
    CHECK(entry.path().filename().string().find("out") == std::string::npos);
  }
}

Failure any_failure() {
  return GENERATE(Failure{"clCreateBuffer", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                  Failure{"clEnqueueNDRangeKernel", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueNDRangeKernel", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                  Failure{"clEnqueueReadBuffer", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueWriteBuffer", -5, "CL_OUT_OF_RESOURCES"},
                  Failure{"clEnqueueFillBuffer", -6, "CL_OUT_OF_HOST_MEMORY"},
                  Failure{"clCreateKernel", -46, "CL_INVALID_KERNEL_NAME"});
}

}  // namespace

TEST_CASE("a render whose 1st, 2nd, 4th, 8th ... OpenCL call of a kind fails says so once") {
  const Failure failure = any_failure();
  const long calls = count_calls(failure);
  for (long at = 1; at < calls; at *= 2) check_failure(failure, at, false);
  check_failure(failure, calls, false);
}

TEST_CASE("a device that is lost in the middle of a render is reported once") {
  const Failure failure = any_failure();
  check_failure(failure, (count_calls(failure) + 1) / 2, true);
}

TEST_CASE("a call that fails on one of two devices ends the render on both, and is told once") {
  const Failure failure = any_failure();
  const char* const halves = "/2";
  const long calls = count_calls(failure, halves);
  for (const bool on : {false, true}) {
    check_failure(failure, (calls + 1) / 2, on, halves);
    check_failure(failure, calls, on, halves);
  }
}

TEST_CASE("a render in which any OpenCL call of a kind fails says so once", "[slow]") {
  const Failure failure = any_failure();
  const long calls = count_calls(failure);
  for (long at = 1; at <= calls; ++at) {
    check_failure(failure, at, false);
    check_failure(failure, at, true);
  }
}

}  // namespace photile::test
