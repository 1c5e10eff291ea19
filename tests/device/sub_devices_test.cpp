// Sub-devices, and several devices opened at once.
#include <catch2/catch.hpp>
#include <numeric>
#include <thread>

#include "device/launch.hpp"
#include "device/program_source.hpp"
#include "photile/errors.hpp"

namespace photile::test {
namespace {

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

}  // namespace

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
  CHECK_THROWS_WITH(Device({.selector = "/2"}),
                    Catch::Contains("2 devices are chosen (0:0.0, 0:0.1)"));
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

}  // namespace photile::test
