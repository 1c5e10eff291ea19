#include "geometry/radix_sort.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <vector>

namespace photile::test {
namespace {

struct Item {
  std::uint64_t key;
  std::uint32_t number;
  bool operator==(const Item&) const = default;
};

}  // namespace

TEST_CASE("A radix sort is a stable sort") {
  const std::size_t count = GENERATE(0, 1, 2, 4095, 100'000);
  const int bits = GENERATE(1, 8, 13, 64);
  CAPTURE(count, bits);
  std::mt19937_64 random(count + static_cast<std::size_t>(bits));
  std::vector<Item> items;
  for (std::size_t i = 0; i < count; ++i) {
    items.push_back({random() >> (64 - bits), static_cast<std::uint32_t>(i)});
  }
  std::vector<Item> expected = items;
  std::stable_sort(expected.begin(), expected.end(),
                   [](const Item& a, const Item& b) { return a.key < b.key; });
  geometry::radix_sort(items, bits, [](const Item& item) { return item.key; });
  CHECK((items == expected));
}

}  // namespace photile::test
