#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "maps/build_steps.hpp"
#include "maps/map_store.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

device::KernelSet kernels() {
  return {device::context_of(test::device()), "shared/scan.cl",
          maps::group_defines(test::device().info())};
}

}  // namespace

TEST_CASE("the device's prefix sum equals the host's for awkward sizes") {
  const device::KernelSet scan = kernels();
  auto& context = scan.context();
  for (const std::size_t size :
       {1u, 2u, 7u, 93u, 2047u, 2048u, 2049u, 4096u, (1u << 20) + 1u, 5u * 1024u * 1024u}) {
    std::mt19937 random(static_cast<unsigned>(size));
    std::vector<std::uint32_t> values(size);
    for (auto& value : values) value = random() % 500;
    std::vector<std::uint32_t> expected(size);
    std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);

    auto buffer = context.upload(std::span<const std::uint32_t>(values), "test values");
    maps::exclusive_prefix_sum(scan, buffer);
    std::vector<std::uint32_t> scanned(size);
    context.read(buffer, std::span(scanned));
    CAPTURE(size);
    CHECK(scanned == expected);
  }
}

TEST_CASE("the prefix sum of nothing is nothing") {
  const device::KernelSet scan = kernels();
  auto buffer = scan.context().allocate<std::uint32_t>(0, "test values");
  CHECK_NOTHROW(maps::exclusive_prefix_sum(scan, buffer));
}

}  // namespace photile::test
