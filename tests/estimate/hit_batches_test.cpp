// How many hits are estimated at a time, at the limits of devices that no machine here has.
#include <catch2/catch.hpp>
#include <vector>

#include "estimate/hit_buffers.hpp"
#include "test_device.hpp"

namespace photile::test {

using estimate::HitBatches;
using estimate::HitBatchNeeds;
using estimate::plan_hit_batch;

namespace {

constexpr std::uint64_t gib = 1ull << 30;

/// One light: 12 bytes out, 16 in.
constexpr HitBatchNeeds one_light_needs{.largest_bytes_per_hit = 12, .bytes_per_hit = 28};
/// 10,000 lights.
constexpr HitBatchNeeds many_lights_needs{.largest_bytes_per_hit = 120'000,
                                          .bytes_per_hit = 120'016};

}  // namespace

TEST_CASE("with memory to spare a batch is a million hits") {
  CHECK(plan_hit_batch(one_light_needs, 16 * gib, 64 * gib) == 1u << 20);
}

TEST_CASE("no index into a batch's outputs passes 32 bits, however large the device's buffers") {
  for (const std::uint64_t bytes : {12ull, 84ull, 120'000ull, 4'000'000ull}) {
    const std::uint64_t hits =
        plan_hit_batch({.largest_bytes_per_hit = bytes, .bytes_per_hit = bytes + 16}, ~0ull, ~0ull);
    CAPTURE(bytes, hits);
    CHECK(hits * bytes <= 0xFFFF'FFFFull);
    CHECK((hits == 1u << 20 || (hits + 1) * bytes > 0xFFFF'FFFFull));
  }
}

TEST_CASE("a batch takes a quarter of the memory and no buffer beyond the largest") {
  const std::uint64_t hits = plan_hit_batch(many_lights_needs, gib / 4, gib);
  CHECK(hits * many_lights_needs.bytes_per_hit <= gib / 4);
  CHECK((hits + 1) * many_lights_needs.bytes_per_hit > gib / 4);
  CHECK(plan_hit_batch(many_lights_needs, 240'000, gib) == 2);
  CHECK(plan_hit_batch(many_lights_needs, 1, 1) == 1);
}

TEST_CASE("work that fails for want of memory is repeated with half the hits, then stays so") {
  HitBatches batches(device::context_of(test::device()));
  std::vector<std::pair<std::size_t, std::size_t>> done;
  int failures = 0;
  const auto work = [&](std::size_t first, std::size_t count) {
    if (count > 30) {
      ++failures;
      throw DeviceMemoryError("too many");
    }
    done.emplace_back(first, count);
  };
  batches.run(100, one_light_needs, work);
  const std::vector<std::pair<std::size_t, std::size_t>> quarters{
      {0, 25}, {25, 25}, {50, 25}, {75, 25}};
  CHECK(done == quarters);
  CHECK(failures == 2);
  batches.run(100, one_light_needs, work);
  CHECK(failures == 2);
}

TEST_CASE("a single hit that does not fit is an error") {
  HitBatches batches(device::context_of(test::device()));
  CHECK_THROWS_AS(batches.run(7, one_light_needs,
                              [](std::size_t, std::size_t) { throw DeviceMemoryError("none"); }),
                  DeviceMemoryError);
}

}  // namespace photile::test
