// What live buffers may take together, and who is asked where they take too much.
#include <catch2/catch.hpp>
#include <vector>

#include "device/context.hpp"

namespace photile::test {
namespace {

using photile::device::Buffer;
using photile::device::Context;
using photile::device::Reclaimer;
using photile::device::ReclaimerEntry;

photile::DeviceOptions limited(std::uint64_t bytes) {
  photile::DeviceOptions options;
  options.memory_bytes = bytes;
  return options;
}

/// Gives one of its buffers back at a time.
struct Hoard final : Reclaimer {
  std::vector<Buffer<std::uint8_t>> buffers;
  int asked = 0;
  bool reclaim() override {
    ++asked;
    if (buffers.empty()) return false;
    buffers.pop_back();
    return true;
  }
};

}  // namespace

TEST_CASE("live buffers together stay within the memory that the user allows") {
  Context context(limited(10'000));
  CHECK(context.memory_limit() == 10'000);
  CHECK(context.largest_buffer() == 10'000);
  const auto first = context.allocate<std::uint8_t>(6'000, "first");
  CHECK_THROWS_AS(context.allocate<std::uint8_t>(4'001, "second"), photile::DeviceMemoryError);
  const auto second = context.allocate<std::uint8_t>(4'000, "second");
  CHECK(context.allocated_bytes() == 10'000);
  CHECK(context.peak_allocated_bytes() == 10'000);
}

TEST_CASE("no more memory is allowed than the device has") {
  Context context(limited(~std::uint64_t{0}));
  CHECK(context.memory_limit() == context.info().global_memory_bytes);
  CHECK(context.largest_buffer() == context.info().max_allocation_bytes);
}

TEST_CASE("too little allowed memory names the option that allows more") {
  Context context(limited(100));
  CHECK_THROWS_WITH(context.allocate<float>(50, "photons"),
                    Catch::Contains("photons (50 x 4 bytes)") &&
                        Catch::Contains("may use 100 bytes") && Catch::Contains("memory limit"));
}

TEST_CASE("an allocation takes what reclaimers release, and no more than it needs") {
  Context context(limited(10'000));
  Hoard hoard;
  const ReclaimerEntry entry(context, hoard);
  for (int i = 0; i < 4; ++i) hoard.buffers.push_back(context.allocate<std::uint8_t>(2'000, ""));
  const auto buffer = context.allocate<std::uint8_t>(5'000, "");
  CHECK(hoard.buffers.size() == 2);
  CHECK_THROWS_AS(context.allocate<std::uint8_t>(5'001, ""), photile::DeviceMemoryError);
  CHECK(hoard.buffers.empty());
}

TEST_CASE("the reclaimer that came last is asked first, one that has gone is not") {
  Context context(limited(4'000));
  Hoard early;
  const ReclaimerEntry early_entry(context, early);
  early.buffers.push_back(context.allocate<std::uint8_t>(1'000, ""));
  Hoard late;
  {
    const ReclaimerEntry late_entry(context, late);
    late.buffers.push_back(context.allocate<std::uint8_t>(1'000, ""));
    context.allocate<std::uint8_t>(3'000, "");
    CHECK(late.buffers.empty());
    CHECK(early.buffers.size() == 1);
  }
  const int asked = late.asked;
  context.allocate<std::uint8_t>(4'000, "");
  CHECK(late.asked == asked);
  CHECK(early.buffers.empty());
}

TEST_CASE("what was saved from a buffer is restored") {
  Context context({});
  const std::vector<std::uint32_t> values{1, 2, 4'000'000'000u};
  auto buffer = context.upload(std::span(values), "values");
  const auto content = context.save(buffer);
  buffer = {};
  CHECK(context.allocated_bytes() == 0);
  context.restore(buffer, content, "values");
  std::vector<std::uint32_t> read(buffer.size());
  context.read(buffer, std::span(read));
  CHECK(read == values);
}

}  // namespace photile::test
