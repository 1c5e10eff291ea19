// Which devices are opened, and parts of them.
#include "device/device_selection.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <thread>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "photile/errors.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using device::DeviceChoice;
using device::select_devices;
using device::untested_gpu;

using Choices = std::vector<DeviceChoice>;

DeviceInfo make(const char* id, const char* name, const char* platform, DeviceType type,
                bool is_pocl = false) {
  DeviceInfo info;
  info.id = id;
  info.name = name;
  info.platform = platform;
  info.type = type;
  info.is_pocl = is_pocl;
  info.compute_units = 8;
  return info;
}

DeviceInfo passed(DeviceInfo device) {
  device.test_result = "passed";
  return device;
}

const std::vector<DeviceInfo> machine = {
    make("0:0", "Oclgrind Simulator", "Oclgrind", DeviceType::cpu),
    make("2:0", "Xeon", "Intel(R) OpenCL", DeviceType::cpu),
    make("3:0", "pthread-skylake", "Portable Computing Language", DeviceType::cpu, true),
    passed(make("4:0", "GeForce 1", "NVIDIA CUDA", DeviceType::gpu)),
    passed(make("4:1", "GeForce 2", "NVIDIA CUDA", DeviceType::gpu)),
    make("5:0", "R9 200 / HD 7900", "AMD", DeviceType::accelerator),
};

/// Sets PHOTILE_DEVICE for one test.
struct Variable {
  explicit Variable(const char* value) { setenv("PHOTILE_DEVICE", value, 1); }
  ~Variable() { unsetenv("PHOTILE_DEVICE"); }
};

/// The one device that a selector means.
std::size_t select_device(std::span<const DeviceInfo> devices, const std::string& selector,
                          std::span<const std::string> left_out = {}) {
  const Choices choices = select_devices(devices, selector, left_out);
  REQUIRE(choices.size() == 1);
  CHECK(choices[0].compute_units.empty());
  return choices[0].index;
}

TEST_CASE("without a selector a GPU comes first, then PoCL, other CPUs, the simulator") {
  const Variable none("");
  CHECK(select_device(machine, "") == 3);
  CHECK(select_device(std::span(machine).first(3), "") == 2);
  CHECK(select_device(std::span(machine).first(2), "") == 1);
  CHECK(select_device(std::span(machine).first(1), "") == 0);
}

TEST_CASE("a GPU that has not passed its test is taken by default only where it is alone") {
  const Variable none("");
  std::vector<DeviceInfo> devices = machine;
  for (const char* result : {"", "the mean irradiance is 2 instead of 1"}) {
    devices[3].test_result = devices[4].test_result = result;
    CHECK(select_device(devices, "") == 2);
    CHECK(select_device(devices, "gpu") == 3);
    const auto why = untested_gpu(devices, devices[2]);
    CHECK_THAT(why, Contains("4:0 GeForce 1 is not used") && Contains("--device 4:0"));
    CHECK_THAT(why, Contains(*result == '\0' ? "photile devices --test" : result));
    CHECK(select_device(std::span(devices).subspan(3, 2), "") == 0);
    CHECK_THAT(untested_gpu(std::span(devices).subspan(3, 2), devices[3]),
               Contains("no other device"));
  }
  devices[3].test_result = "";
  devices[4].test_result = "passed";
  CHECK(select_device(devices, "") == 4);
  CHECK(untested_gpu(devices, devices[4]).empty());
  CHECK(untested_gpu(std::span(devices).first(3), devices[2]).empty());
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

TEST_CASE("all means every device but the simulator, which is taken where it is alone") {
  CHECK(select_devices(machine, "all") == Choices{{1}, {2}, {3}, {4}, {5}});
  CHECK(select_devices(machine, "ALL") == select_devices(machine, "all"));
  CHECK(select_devices(std::span(machine).first(1), "all") == Choices{{0}});
}

TEST_CASE("a list means each of its devices, in its order") {
  CHECK(select_devices(machine, "gpu,4:1,portable") == Choices{{3}, {4}, {2}});
  const Variable variable("xeon,gpu");
  CHECK(select_devices(machine, "") == Choices{{1}, {3}});
}

TEST_CASE("a suffix splits a device into equal parts or takes counts of compute units") {
  CHECK(select_devices(machine, "cpu/2") == Choices{{2, {4, 4}}});
  CHECK(select_devices(machine, "cpu/3") == Choices{{2, {2, 3, 3}}});
  CHECK(select_devices(machine, "cpu=7") == Choices{{2, {7}}});
  CHECK(select_devices(machine, "gpu,2:0=1+4") == Choices{{3}, {1, {1, 4}}});
  CHECK(select_devices(machine, "/2") == Choices{{3, {4, 4}}});
}

TEST_CASE("a name may hold a stroke of its own") {
  CHECK(select_device(machine, "200 / hd 7900") == 5);
  CHECK(select_devices(machine, "200 / hd 7900/4") == Choices{{5, {2, 2, 2, 2}}});
}

TEST_CASE("more parts than compute units, and partitions without a number, are refused") {
  for (const char* selector : {"cpu/9", "cpu=9", "cpu=4+5", "cpu=999999999+999999999"}) {
    INFO(selector);
    CHECK_THROWS_WITH(select_devices(machine, selector),
                      Contains(selector) && Contains("3:0") && Contains(" 8;"));
  }
  for (const char* selector : {"cpu/0", "cpu=", "cpu=1+", "cpu=-1", "cpu/9999999999", "cpu/x"}) {
    INFO(selector);
    CHECK_THROWS_WITH(select_devices(machine, selector), Contains("matches no"));
  }
}

TEST_CASE("a device named twice, and a comma without a device, are refused") {
  CHECK_THROWS_WITH(select_devices(machine, "2:0,gpu,xeon"),
                    Contains("2:0 Xeon twice") && Contains("once"));
  CHECK_THROWS_WITH(select_devices(machine, "cpu=1,cpu=1"), Contains("twice"));
  for (const char* selector : {"gpu,", ",gpu", "cpu,,gpu", ","}) {
    INFO(selector);
    CHECK_THROWS_WITH(select_devices(machine, selector), Contains("comma"));
  }
}

TEST_CASE("a selector without a match lists the devices and its source") {
  for (const char* selector : {"radeon", "6", "1:7", "99999999999999999999999"}) {
    INFO(selector);
    CHECK_THROWS_WITH(select_devices(machine, selector), Contains(selector) &&
                                                             Contains("3:0 pthread-skylake") &&
                                                             Contains("4:1 GeForce 2"));
  }
  const Variable variable("radeon");
  CHECK_THROWS_WITH(select_devices(machine, ""), Contains("PHOTILE_DEVICE 'radeon'"));
}

TEST_CASE("without devices the message says what to install and what was left out") {
  CHECK_THROWS_WITH(select_devices({}, "gpu"),
                    Contains("no OpenCL runtime is installed") && Contains("pocl-opencl-icd"));
  const std::vector<std::string> left_out = {"rusticl: has no devices"};
  CHECK_THROWS_WITH(select_devices({}, "", left_out), Contains("rusticl: has no devices"));
  CHECK_THROWS_AS(select_devices({}, ""), DeviceError);
}

TEST_CASE("every listed device can be opened by its id") {
  const auto devices = list_devices();
  REQUIRE_FALSE(devices.empty());
  for (const auto& info : devices) {
    INFO(info.id << ' ' << info.name);
    const Device device({info.id, true, false});
    CHECK(device.info().id == info.id);
    CHECK(device.info().max_allocation_bytes > 0);
    CHECK(device.info().global_memory_bytes >= device.info().max_allocation_bytes);
  }
}

// Sub-devices, and several devices opened at once.

constexpr const char* source = R"(
kernel void thirds(global float* out, const uint n) {
  const uint i = get_global_id(0);
  if (i < n) out[i] = (float)i / 3.0f;
}
)";

std::vector<float> thirds(device::Context& context, unsigned n) {
  auto buffer = context.allocate<float>(n, "thirds");
  device::Launch(context, context.kernel("test/thirds.cl", "thirds", {}))
      .set("out", buffer)
      .set("n", n)
      .run(n, 64);
  std::vector<float> values(n);
  context.read<float>(buffer, values);
  return values;
}

TEST_CASE("the parts of a split device hold its compute units and share its memory") {
  const DeviceInfo whole = Device().info();
  REQUIRE(whole.compute_units >= 2);
  const std::vector<Device> parts = open_devices({.selector = "/2"});
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].info().id == whole.id + ".0");
  CHECK(parts[1].info().id == whole.id + ".1");
  std::uint32_t compute_units = 0;
  std::uint64_t memory = 0;
  for (const Device& part : parts) {
    CHECK(part.info().parent == whole.id);
    CHECK(part.info().name == whole.name);
    CHECK(part.info().max_allocation_bytes <= part.info().global_memory_bytes);
    compute_units += part.info().compute_units;
    memory += part.info().global_memory_bytes;
  }
  CHECK(compute_units == whole.compute_units);
  CHECK(memory <= whole.global_memory_bytes);
}

TEST_CASE("one part of a device leaves the rest of it alone") {
  const Device device({.selector = "=1"});
  CHECK(device.info().compute_units == 1);
  CHECK(device.info().global_memory_bytes == Device().info().global_memory_bytes);
}

TEST_CASE("several devices are refused where one is needed") {
  CHECK_THROWS_WITH(Device({.selector = "/2"}), Contains("2 devices are selected (0:0.0, 0:0.1)"));
}

TEST_CASE("two sub-devices compute at once, compiling the same program") {
  device::register_kernel_source("test/thirds.cl", source);
  constexpr unsigned n = 100'000;
  const bool use_program_cache = GENERATE(true, false);
  std::vector<Device> devices =
      open_devices({.selector = "/2", .use_program_cache = use_program_cache});
  std::vector<std::vector<float>> values(devices.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      threads.emplace_back([&, i] { values[i] = thirds(device::context_of(devices[i]), n); });
    }
  }
  for (const auto& computed : values) {
    REQUIRE(computed.size() == n);
    std::size_t wrong = 0;
    for (unsigned i = 0; i < n; ++i) wrong += computed[i] != static_cast<float>(i) / 3.0f;
    CHECK(wrong == 0);
  }
}

}  // namespace
}  // namespace photile::test
