// OpenCL that is missing, fails or lacks memory.
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>

#include "child_process.hpp"
#include "device/context.hpp"
#include "device/opencl.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using device::Context;

// Each OpenCL call that the probe makes fails in turn.

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
      CHECK_THAT(result.errors, Contains(failure.call) || Contains("test/squares.cl"));
      CHECK_THAT(result.errors, Contains(failure.name));
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
  REQUIRE(calls >= 2);
  const auto first = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 1, false, ""));
  CHECK(first.exit_code == 4);
  CHECK_THAT(first.errors, Contains("clFinish failed: CL_INVALID_COMMAND_QUEUE (-36)"));
  const auto last = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, calls, false, ""));
  CHECK(last.exit_code == 0);
}

TEST_CASE("a launch that runs out of memory says what the device has and what to change") {
  const Failure failure{"clEnqueueNDRangeKernel", -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"};
  const auto result = run_child({PHOTILE_DEVICE_PROBE, "run"}, failing(failure, 1, true, ""));
  CHECK(result.exit_code == 4);
  CHECK_THAT(result.errors,
             Contains("'squares'") && Contains("4000 are in use") && Contains("use fewer photons"));
}

ChildResult probe(const char* mode, bool fence, const char* kind = "page") {
  // The address sanitizer would turn the signal into an exit code of its own. Leaks are not the
  // subject here.
  ChildEnvironment environment = {{"ASAN_OPTIONS", "handle_segv=0:detect_leaks=0"}};
  if (fence) environment["OPENCL_LAYERS"] = PHOTILE_FENCE_LAYER;
  environment["PHOTILE_FENCE"] = kind;
  return run_child({PHOTILE_DEVICE_PROBE, mode}, environment);
}

TEST_CASE("a correct kernel gives the same results behind the fence") {
  const auto plain = probe("run", false);
  const auto fenced = probe("run", true);
  INFO(plain.errors << fenced.errors);
  CHECK(plain.exit_code == 0);
  CHECK(fenced.exit_code == 0);
  // The sum of i^2 for i < 1000 is 999 * 1000 * 1999 / 6.
  CHECK_THAT(plain.output, Contains("last=998001 sum=332833500"));
  CHECK_THAT(fenced.output, Contains("last=998001 sum=332833500"));
}

TEST_CASE("a kernel that writes one element past the end dies at the fence") {
  CHECK(probe("overrun", true).signal == SIGSEGV);
}

TEST_CASE("what no kernel wrote shows behind the fence") {
  const char* kind = GENERATE("page", "guard");
  CHECK_THAT(probe("unwritten", true, kind).output, Contains("last=-1 "));
}

TEST_CASE("a kernel that writes beyond its buffer is told where guards stand in place of pages") {
  CHECK_THAT(probe("run", true, "guard").output, Contains("last=998001 sum=332833500"));
  const auto [mode, where] =
      GENERATE(table<const char*, const char*>({{"overrun", "wrote behind a buffer of 4000"},
                                                {"underrun", "wrote before a buffer of 4000"}}));
  const ChildResult result = probe(mode, true, "guard");
  CHECK(result.signal == SIGABRT);
  CHECK_THAT(result.errors, Contains(where));
}

// Machines without OpenCL, or with runtimes that offer nothing.

ChildResult probe_vendors(const std::filesystem::path& vendors, ChildEnvironment environment = {}) {
  environment["OCL_ICD_VENDORS"] = vendors.string();
  return run_child({PHOTILE_DEVICE_PROBE, "run"}, environment);
}

void check_one_device_error(const ChildResult& result, const char* text) {
  INFO(result.errors);
  CHECK(result.exit_code == 4);
  CHECK_THAT(result.errors, Contains(text) && Contains("pocl-opencl-icd"));
  CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
}

TEST_CASE("without a runtime the message says what to install") {
  const TemporaryFolder vendors;
  check_one_device_error(probe_vendors(vendors.path), "no OpenCL runtime is installed");
}

TEST_CASE("of a runtime whose library cannot be loaded the loader's reason is told") {
  const TemporaryFolder vendors;
  std::ofstream(vendors.path / "gone.icd") << "libphotile-no-such-runtime.so\n";
  check_one_device_error(probe_vendors(vendors.path),
                         "gone.icd: libphotile-no-such-runtime.so: cannot open shared object file");
}

TEST_CASE("a platform without devices is named, not opened") {
  const TemporaryFolder vendors;
  std::ofstream(vendors.path / "pocl.icd") << "libpocl.so.2\n";
  check_one_device_error(probe_vendors(vendors.path, {{"POCL_DEVICES", "none-such"}}),
                         "no devices");
}

TEST_CASE("an absurd allocation says what, how much, the limits and a remedy") {
  Context context({});
  const auto limit = std::to_string(context.info().max_allocation_bytes);
  try {
    context.allocate<float>(1ull << 50, "photon references");
    FAIL("allocated");
  } catch (const DeviceError& error) {
    CHECK_THAT(error.what(), Contains("photon references"));
    CHECK_THAT(error.what(), Contains("1125899906842624 x 4 bytes"));
    CHECK_THAT(error.what(), Contains(limit));
    CHECK_THAT(error.what(), Contains("fewer photons"));
    CHECK(error.status == -61);  // CL_INVALID_BUFFER_SIZE
  }
  CHECK(context.allocated_bytes() == 0);
}

TEST_CASE("a size whose bytes overflow 64 bits is refused, not wrapped") {
  Context context({});
  CHECK_THROWS_AS(context.allocate<double>(1ull << 62, "wrap"), DeviceError);
}

TEST_CASE("status codes have names") {
  using device::status_name;
  CHECK(status_name(0) == "CL_SUCCESS (0)");
  CHECK(status_name(-5) == "CL_OUT_OF_RESOURCES (-5)");
  CHECK(status_name(-1001) == "CL_PLATFORM_NOT_FOUND_KHR (-1001)");
  CHECK(status_name(-4321) == "unknown status (-4321)");
}

}  // namespace
}  // namespace photile::test
