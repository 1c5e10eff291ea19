#include <catch2/catch.hpp>
#include <cstdlib>
#include <set>

#include "device/kernel_store.hpp"

namespace photile::test {
namespace {

using photile::DeviceInfo;
using photile::device::program_key;

DeviceInfo device() {
  DeviceInfo info;
  info.name = "name";
  info.platform = "platform";
  info.vendor = "vendor";
  info.version = "OpenCL 1.2";
  info.driver_version = "driver 1";
  info.platform_version = "OpenCL 1.2 platform";
  return info;
}

}  // namespace

TEST_CASE("whatever may change a program's code changes its key") {
  std::set<std::string> keys;
  const auto add = [&](const DeviceInfo& info, const char* options, const char* source) {
    keys.insert(program_key(info, options, source).hex());
  };
  add(device(), "options", "source");
  add(device(), "options2", "source");
  add(device(), "options", "source2");
  add(device(), "optionss", "ource");
  for (auto field :
       {&DeviceInfo::name, &DeviceInfo::platform, &DeviceInfo::vendor, &DeviceInfo::version,
        &DeviceInfo::driver_version, &DeviceInfo::platform_version}) {
    auto info = device();
    info.*field += "x";
    add(info, "options", "source");
  }
  CHECK(keys.size() == 10);
  add(device(), "options", "source");
  CHECK(keys.size() == 10);
}

TEST_CASE("Code generation variables of PoCL and of Intel's runtime are in their keys alone") {
  auto pocl = device();
  pocl.is_pocl = true;
  const auto plain = program_key(pocl, "", "s");
  const auto plain_other = program_key(device(), "", "s");
  ::setenv("POCL_WORK_GROUP_METHOD", "loops", 1);
  const auto loops = program_key(pocl, "", "s");
  const auto loops_other = program_key(device(), "", "s");
  ::setenv("POCL_WORK_GROUP_METHOD", "cbs", 1);
  const auto cbs = program_key(pocl, "", "s");
  ::unsetenv("POCL_WORK_GROUP_METHOD");
  ::setenv("CL_CONFIG_CPU_TARGET_ARCH", "core-avx2", 1);
  const auto intel = program_key(device(), "", "s");
  const auto intel_pocl = program_key(pocl, "", "s");
  ::unsetenv("CL_CONFIG_CPU_TARGET_ARCH");
  CHECK_FALSE(plain_other == intel);
  CHECK(plain == intel_pocl);
  CHECK_FALSE(plain == loops);
  CHECK_FALSE(loops == cbs);
  CHECK(plain_other == loops_other);
  CHECK(program_key(pocl, "", "s") == plain);
}

TEST_CASE("a hash is XXH3-128 as its specification gives it for the empty text") {
  CHECK(photile::device::hash("").hex() == "99aa06d3014798d86001c324468d497f");
}

}  // namespace photile::test
