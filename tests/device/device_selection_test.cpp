#include "device/device_selection.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "photile/errors.hpp"

namespace {

using photile::DeviceInfo;
using photile::DeviceType;
using photile::device::select_device;

DeviceInfo make(const char* id, const char* name, const char* platform, DeviceType type,
                bool is_pocl = false) {
  DeviceInfo info;
  info.id = id;
  info.name = name;
  info.platform = platform;
  info.type = type;
  info.is_pocl = is_pocl;
  return info;
}

const std::vector<DeviceInfo> machine = {
    make("0:0", "Oclgrind Simulator", "Oclgrind", DeviceType::cpu),
    make("2:0", "Xeon", "Intel(R) OpenCL", DeviceType::cpu),
    make("3:0", "pthread-skylake", "Portable Computing Language", DeviceType::cpu, true),
    make("4:0", "GeForce 1", "NVIDIA CUDA", DeviceType::gpu),
    make("4:1", "GeForce 2", "NVIDIA CUDA", DeviceType::gpu),
};

/// Sets PHOTILE_DEVICE for one test.
struct Variable {
  explicit Variable(const char* value) { setenv("PHOTILE_DEVICE", value, 1); }
  ~Variable() { unsetenv("PHOTILE_DEVICE"); }
};

}  // namespace

TEST_CASE("without a selector a GPU comes first, then PoCL, other CPUs, the simulator") {
  const Variable none("");
  CHECK(select_device(machine, "") == 3);
  CHECK(select_device(std::span(machine).first(3), "") == 2);
  CHECK(select_device(std::span(machine).first(2), "") == 1);
  CHECK(select_device(std::span(machine).first(1), "") == 0);
}

TEST_CASE("a selector is platform:device, an index, a type or a part of a name") {
  CHECK(select_device(machine, "4:1") == 4);
  CHECK(select_device(machine, "1") == 1);
  CHECK(select_device(machine, "cpu") == 2);
  CHECK(select_device(machine, "GPU") == 3);
  CHECK(select_device(machine, "xeon") == 1);
  CHECK(select_device(machine, "portable") == 2);
  CHECK(select_device(machine, "force 2") == 4);
}

TEST_CASE("the environment's selector holds where none is given") {
  const Variable variable("Xeon");
  CHECK(select_device(machine, "") == 1);
  CHECK(select_device(machine, "4:0") == 3);
}

TEST_CASE("a selector without a match lists the devices and its source") {
  for (const char* selector : {"radeon", "5", "1:7", "99999999999999999999999"}) {
    INFO(selector);
    CHECK_THROWS_WITH(select_device(machine, selector),
                      Catch::Contains(selector) && Catch::Contains("3:0 pthread-skylake") &&
                          Catch::Contains("4:1 GeForce 2"));
  }
  const Variable variable("radeon");
  CHECK_THROWS_WITH(select_device(machine, ""), Catch::Contains("PHOTILE_DEVICE 'radeon'"));
}

TEST_CASE("without devices the message says what to install and what was left out") {
  CHECK_THROWS_WITH(select_device({}, "gpu"), Catch::Contains("no OpenCL runtime is installed") &&
                                                  Catch::Contains("pocl-opencl-icd"));
  const std::vector<std::string> left_out = {"rusticl: has no devices"};
  CHECK_THROWS_WITH(select_device({}, "", left_out), Catch::Contains("rusticl: has no devices"));
  CHECK_THROWS_AS(select_device({}, ""), photile::DeviceError);
}

TEST_CASE("every listed device can be opened by its id") {
  const auto devices = photile::list_devices();
  REQUIRE_FALSE(devices.empty());
  for (const auto& info : devices) {
    INFO(info.id << ' ' << info.name);
    const photile::Device device({info.id, true, false});
    CHECK(device.info().id == info.id);
    CHECK(device.info().max_allocation_bytes > 0);
    CHECK(device.info().global_memory_bytes >= device.info().max_allocation_bytes);
  }
}
