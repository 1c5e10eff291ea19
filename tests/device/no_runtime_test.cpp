// Machines without OpenCL, or with runtimes that offer nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "child_process.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

ChildResult probe_vendors(const std::filesystem::path& vendors, ChildEnvironment environment = {}) {
  environment["OCL_ICD_VENDORS"] = vendors.string();
  return run_child({PHOTILE_DEVICE_PROBE, "run"}, environment);
}

void check_one_device_error(const ChildResult& result, const char* text) {
  INFO(result.errors);
  CHECK(result.exit_code == 4);
  CHECK_THAT(result.errors, Catch::Contains(text) && Catch::Contains("pocl-opencl-icd"));
  CHECK(std::count(result.errors.begin(), result.errors.end(), '\n') == 1);
}

}  // namespace

TEST_CASE("without a runtime the message says what to install") {
  const TemporaryFolder vendors;
  check_one_device_error(probe_vendors(vendors.path), "no OpenCL runtime is installed");
}

TEST_CASE("a runtime whose library is missing counts as none") {
  const TemporaryFolder vendors;
  std::ofstream(vendors.path / "gone.icd") << "libphotile-no-such-runtime.so\n";
  check_one_device_error(probe_vendors(vendors.path), "no OpenCL runtime is installed");
}

TEST_CASE("a platform without devices is named, not opened") {
  const TemporaryFolder vendors;
  std::ofstream(vendors.path / "pocl.icd") << "libpocl.so.2\n";
  check_one_device_error(probe_vendors(vendors.path, {{"POCL_DEVICES", "none-such"}}),
                         "no devices");
}

}  // namespace photile::test
