// Names of numbered frames.
#include <catch2/catch.hpp>

#include "photile/errors.hpp"
#include "walk/frames.hpp"

namespace photile::test {

using walk::FrameNames;

TEST_CASE("hashes and printf's numbers become frame numbers, as wide as they say at least") {
  const auto [pattern, frame, name] = GENERATE(table<std::string, int, std::string>({
      {"frame.####.exr", 7, "frame.0007.exr"},
      {"frame.####.exr", 123456, "frame.123456.exr"},
      {"#.exr", 12, "12.exr"},
      {"a%04d.exr", 7, "a0007.exr"},
      {"a%d.exr", 7, "a7.exr"},
      {"a%3d.exr", 7, "a  7.exr"},
      {"a%%0d.exr", 7, "a%7.exr"},
      {"c#/b##.exr", 3, "c#/b03.exr"},
      {"out/walk.png", 3, "out/walk.0003.png"},
      {"walk", 3, "walk.0003"},
  }));
  CHECK(FrameNames(pattern).of(frame).string() == name);
}

TEST_CASE("a place of any width takes no more stack than another") {
  const std::string hashes(200'000, '#');
  CHECK(FrameNames(hashes + ".exr").of(7).string() == std::string(199'999, '0') + "7.exr");
}

TEST_CASE("a name with two places for the number, or a wrong one, is refused") {
  const std::string pattern =
      GENERATE("##-##.exr", "a%d#.exr", "####/frame.exr", "%s.exr", "%0", "%00d", "%12d");
  INFO(pattern);
  CHECK_THROWS_AS(FrameNames(pattern), UsageError);
}

}  // namespace photile::test
