// Ranges of frames as render farms write them.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "walk/frames.hpp"

namespace photile::test {

TEST_CASE("a range of frames is one, all between two, or every so many of them") {
  const auto [text, numbers] = GENERATE(table<std::string, std::vector<int>>({
      {"7", {7}},
      {"0", {0}},
      {"3-6", {3, 4, 5, 6}},
      {"3-3", {3}},
      {"1-10x4", {1, 5, 9}},
  }));
  const auto range = walk::parse_frame_range(text);
  REQUIRE(range);
  std::vector<int> found;
  for (int number = 0; number < 20; ++number) {
    if (range->contains(number)) found.push_back(number);
  }
  CHECK(found == numbers);
}

TEST_CASE("what is no range of frames is none") {
  const std::string text =
      GENERATE("", "-", "-3", "3-", "6-3", "1-4x0", "1-4x", "1-4x-1", "a", "1 - 4", "1-4x2x2",
               "1.5", "99999999999", "1-99999999999", "+1");
  CAPTURE(text);
  CHECK_FALSE(walk::parse_frame_range(text));
}

}  // namespace photile::test
