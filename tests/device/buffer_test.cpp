// Buffers, and what they may take together.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

#include "device/context.hpp"

namespace photile::test {
namespace {

using device::Buffer;
using device::Context;
using device::Reclaimer;

std::vector<int> counted(std::size_t size) {
  std::vector<int> values(size);
  std::iota(values.begin(), values.end(), 0);
  return values;
}

template <class T>
std::vector<T> content_of(Context& context, const Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  context.read(buffer, std::span(values));
  return values;
}

TEST_CASE("an uploaded buffer reads back as it was") {
  Context context({});
  const auto values = counted(1000);
  const auto buffer = context.upload<int>(values, "values");
  CHECK(content_of(context, buffer) == values);
}

TEST_CASE("a write and a read at an offset touch those elements only") {
  Context context({});
  auto buffer = context.upload<int>(counted(10), "values");
  const std::vector<int> inserted = {-1, -2, -3};
  context.write<int>(buffer, inserted, 4);
  CHECK(content_of(context, buffer) == std::vector<int>{0, 1, 2, 3, -1, -2, -3, 7, 8, 9});
  std::vector<int> part(2);
  context.read<int>(buffer, part, 6);
  CHECK(part == std::vector<int>{-3, 7});
}

TEST_CASE("fill sets a range, perhaps of millions, and leaves the rest") {
  Context context({});
  for (const auto& [size, first, count] : {std::array{6, 2, 3}, {3'000'001, 7, 2'500'003}}) {
    std::vector<int> expected = counted(size);
    auto buffer = context.upload<int>(expected, "values");
    context.fill(buffer, 9, first, count);
    context.fill(buffer, 8, 0, 0);
    std::fill_n(expected.begin() + first, count, 9);
    CHECK((content_of(context, buffer) == expected));
  }
}

TEST_CASE("an output is zero until it is written, and is read into the values it was made for") {
  Context context({});
  std::vector<int> values(1000);
  auto buffer = context.share_output<int>(values, "values");
  context.fill(buffer, 9, 2, 3);
  context.read<int>(buffer, values);
  std::vector<int> expected(1000);
  std::fill_n(expected.begin() + 2, 3, 9);
  CHECK(values == expected);
}

TEST_CASE("a shared buffer holds the host's values, and outlives its context") {
  const auto values = counted(1000);
  device::Buffer<int> outliving;
  {
    Context context({});
    const std::uint64_t before = context.allocated_bytes();
    outliving = context.share<int>(values, "values");
    if (context.info().type == DeviceType::cpu) {
      CHECK(context.allocated_bytes() == before);
    }
    CHECK(content_of(context, outliving) == values);
    CHECK(context.share<int>({}, "nothing").size() == 0);
  }
}

TEST_CASE("a transfer past the end of a buffer is refused") {
  Context context({});
  auto buffer = context.allocate<int>(10, "values");
  std::vector<int> values(3);
  CHECK_THROWS_AS(context.read<int>(buffer, values, 8), DeviceError);
  CHECK_THROWS_AS(context.write<int>(buffer, values, 8), DeviceError);
  CHECK_THROWS_AS(context.read<int>(buffer, values, 11), DeviceError);
}

TEST_CASE("fill sets every element, also of sizes that OpenCL has no pattern for") {
  struct Triple {
    float x, y, z;
  };
  Context context({});
  auto numbers = context.allocate<unsigned>(1001, "numbers");
  context.fill(numbers, 0xDEADBEEFu);
  CHECK(content_of(context, numbers) == std::vector<unsigned>(1001, 0xDEADBEEFu));

  // 12 bytes; more than one of the blocks of 1 MiB that such a fill goes by.
  const std::size_t count = 200'003;
  auto triples = context.allocate<Triple>(count, "triples");
  context.fill(triples, Triple{1, 2, 3});
  std::size_t wrong = 0;
  for (const Triple& t : content_of(context, triples)) {
    wrong += !(t.x == 1 && t.y == 2 && t.z == 3);
  }
  CHECK(wrong == 0);
}

TEST_CASE("a buffer of zero elements can be allocated, filled, written and read") {
  Context context({});
  auto buffer = context.allocate<float>(0, "nothing");
  CHECK(buffer.size() == 0);
  CHECK(buffer.raw().handle() != nullptr);
  context.fill(buffer, 1.0f);
  context.write<float>(buffer, {});
  context.read<float>(buffer, {});
  context.finish();
}

TEST_CASE("live and peak bytes count buffers, also those moved") {
  Context context({});
  CHECK(context.allocated_bytes() == 0);
  {
    auto first = context.allocate<char>(1000, "first");
    auto second = context.allocate<char>(500, "second");
    CHECK(context.allocated_bytes() == 1500);
    first = std::move(second);
    CHECK(context.allocated_bytes() >= 500);
  }
  CHECK(context.allocated_bytes() == 0);
  CHECK(context.peak_allocated_bytes() == 1500);
}

TEST_CASE("a buffer may outlive its context") {
  device::Buffer<int> buffer;
  {
    Context context({});
    buffer = context.allocate<int>(10, "survivor");
  }
  CHECK(buffer.size() == 10);
}

// What live buffers may take together, and who is asked where they take too much.

DeviceOptions limited(std::uint64_t bytes) {
  DeviceOptions options;
  options.memory_bytes = bytes;
  return options;
}

/// Gives one of its buffers back at a time.
struct Hoard final : Reclaimer {
  using Reclaimer::Reclaimer;
  std::vector<Buffer<std::uint8_t>> buffers;
  bool reclaim() override {
    if (buffers.empty()) return false;
    buffers.pop_back();
    return true;
  }
};

TEST_CASE("live buffers together stay within the memory that the user allows") {
  Context context(limited(10'000));
  CHECK(context.memory_limit() == 10'000);
  CHECK(context.largest_buffer() == 10'000);
  const auto first = context.allocate<std::uint8_t>(6'000, "first");
  CHECK_THROWS_AS(context.allocate<std::uint8_t>(4'001, "second"), DeviceMemoryError);
  const auto second = context.allocate<std::uint8_t>(4'000, "second");
  CHECK(context.allocated_bytes() == 10'000);
  CHECK(context.peak_allocated_bytes() == 10'000);
}

TEST_CASE("memory that a buffer released serves the next, and makes room where it is too small") {
  Context context(limited(10'000));
  auto buffer = context.allocate<std::uint8_t>(6'000, "first");
  const void* const memory = buffer.raw().handle();
  buffer = {};
  CHECK(context.allocated_bytes() == 0);
  const auto much_smaller = context.allocate<std::uint8_t>(2'000, "much smaller");
  CHECK(much_smaller.raw().handle() != memory);
  buffer = context.allocate<std::uint8_t>(5'000, "second");
  CHECK(buffer.raw().handle() == memory);
  CHECK(buffer.size() == 5'000);
  CHECK(context.allocated_bytes() == 8'000);
  buffer = {};
  CHECK_NOTHROW(context.allocate<std::uint8_t>(8'000, "third"));
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
  Hoard hoard(context);
  for (int i = 0; i < 4; ++i) hoard.buffers.push_back(context.allocate<std::uint8_t>(2'000, ""));
  const auto buffer = context.allocate<std::uint8_t>(5'000, "");
  CHECK(hoard.buffers.size() == 2);
  CHECK_THROWS_AS(context.allocate<std::uint8_t>(5'001, ""), DeviceMemoryError);
  CHECK(hoard.buffers.empty());
}

TEST_CASE("the reclaimer that came last is asked first, one that has gone is not") {
  Context context(limited(4'000));
  Hoard early(context);
  early.buffers.push_back(context.allocate<std::uint8_t>(1'000, ""));
  {
    Hoard late(context);
    late.buffers.push_back(context.allocate<std::uint8_t>(1'000, ""));
    context.allocate<std::uint8_t>(3'000, "");
    CHECK(late.buffers.empty());
    CHECK(early.buffers.size() == 1);
  }
  context.allocate<std::uint8_t>(4'000, "");
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
  CHECK(content_of(context, buffer) == values);
}

}  // namespace
}  // namespace photile::test
