// Each OpenCL call that the probe makes fails in turn.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "child_process.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

struct Failure {
  const char* call;
  int status;
  const char* name;
  bool repeated = false;  ///< the call is made again where it runs out of memory
};

ChildEnvironment failing(const Failure& failure, long at, bool on, const std::string& count_file) {
  return {{"OPENCL_LAYERS", PHOTILE_FAILING_LAYER},
          {"PHOTILE_FAIL_CALL", failure.call},
          {"PHOTILE_FAIL_AT", std::to_string(at)},
          {"PHOTILE_FAIL_STATUS", std::to_string(failure.status)},
          {"PHOTILE_FAIL_ON", on ? "1" : "0"},
          {"PHOTILE_FAIL_COUNT_FILE", count_file}};
}

long count_calls(const Failure& failure) {
  const TemporaryFolder folder;
  const auto file = folder.path / "count";
  const auto result =
      run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 0, false, file.string()));
  REQUIRE(result.exit_code == 0);
  long count = 0;
  std::ifstream(file) >> count;
  return count;
}

}  // namespace

TEST_CASE("a failing OpenCL call ends in one message and the device exit code") {
  const auto failure =
      GENERATE(Failure{"clCreateContext", -6, "CL_OUT_OF_HOST_MEMORY"},
               Failure{"clCreateCommandQueue", -5, "CL_OUT_OF_RESOURCES"},
               Failure{"clCreateBuffer", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE", true},
               Failure{"clCreateProgramWithSource", -6, "CL_OUT_OF_HOST_MEMORY"},
               Failure{"clBuildProgram", -11, "CL_BUILD_PROGRAM_FAILURE"},
               Failure{"clCreateKernel", -46, "CL_INVALID_KERNEL_NAME"},
               Failure{"clSetKernelArg", -50, "CL_INVALID_ARG_VALUE"},
               Failure{"clEnqueueNDRangeKernel", -5, "CL_OUT_OF_RESOURCES", true},
               Failure{"clEnqueueReadBuffer", -5, "CL_OUT_OF_RESOURCES", true});
  const long calls = count_calls(failure);
  INFO(failure.call << ", " << calls << " calls");
  REQUIRE(calls > 0);
  for (long at = 1; at <= calls; ++at) {
    for (const bool on : {false, true}) {
      if (!on && failure.repeated) continue;
      const auto result = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, at, on, ""));
      INFO("call " << at << ": " << result.errors);
      CHECK(result.exit_code == 4);
      CHECK_THAT(result.errors,
                 Catch::Contains(failure.call) || Catch::Contains("test/squares.cl"));
      CHECK_THAT(result.errors, Catch::Contains(failure.name));
      CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
    }
  }
}

TEST_CASE("a call that runs out of memory once is made again, with the same result") {
  const auto failure =
      GENERATE(Failure{"clCreateBuffer", -4, ""}, Failure{"clCreateKernel", -6, ""},
               Failure{"clSetKernelArg", -6, ""}, Failure{"clEnqueueNDRangeKernel", -5, ""},
               Failure{"clEnqueueReadBuffer", -5, ""});
  for (long at = 1, calls = count_calls(failure); at <= calls; ++at) {
    const auto result = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, at, false, ""));
    INFO(failure.call << ", call " << at << ": " << result.errors);
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.output, Catch::StartsWith("last=998001 sum=332833500 "));
  }
}

TEST_CASE("a failing clFinish is reported where a result depends on it, and ignored at the end") {
  const Failure failure{"clFinish", -36, "CL_INVALID_COMMAND_QUEUE"};
  const long calls = count_calls(failure);
  REQUIRE(calls == 2);
  const auto first = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 1, false, ""));
  CHECK(first.exit_code == 4);
  CHECK_THAT(first.errors, Catch::Contains("clFinish failed: CL_INVALID_COMMAND_QUEUE (-36)"));
  const auto last = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 2, false, ""));
  CHECK(last.exit_code == 0);
}

TEST_CASE("a launch that runs out of memory says what the device has and what to change") {
  const Failure failure{"clEnqueueNDRangeKernel", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"};
  const auto result = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 1, true, ""));
  CHECK(result.exit_code == 4);
  CHECK_THAT(result.errors, Catch::Contains("'squares'") &&
                                Catch::Contains("4000 bytes are in use") &&
                                Catch::Contains("use fewer photons"));
}

}  // namespace photile::test
