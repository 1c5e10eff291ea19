#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "image/display.hpp"

namespace photile::test {

using namespace photile::image;

namespace {

/// The definition: the nearest code of the encoded value.
int nearest_code(float linear) {
  return static_cast<int>(std::lround(255.0 * srgb_from_linear(linear)));
}

}  // namespace

TEST_CASE("each 8-bit code begins at the float where rounding says so") {
  for (int code = 1; code < 256; ++code) {
    const auto middle = static_cast<float>(linear_from_srgb((code - 0.5) / 255.0));
    float value = middle;
    for (int i = 0; i < 8; ++i) value = std::nextafter(value, 0.0f);
    for (int i = 0; i < 16; ++i, value = std::nextafter(value, 1.0f)) {
      INFO("code " << code << ", value " << value);
      REQUIRE(srgb8_from_linear(value) == nearest_code(value));
    }
  }
}

TEST_CASE("8-bit codes of values of all sizes are those of the curve") {
  for (std::uint32_t bits = 1; bits <= std::bit_cast<std::uint32_t>(1.0f); bits += 9973) {
    const auto value = std::bit_cast<float>(bits);
    if (srgb8_from_linear(value) != nearest_code(value)) {
      FAIL("value " << value << " has code " << int{srgb8_from_linear(value)});
    }
  }
}

TEST_CASE("8-bit codes of values outside the range are its ends") {
  CHECK(srgb8_from_linear(0.0f) == 0);
  CHECK(srgb8_from_linear(-1.0f) == 0);
  CHECK(srgb8_from_linear(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(srgb8_from_linear(1.0f) == 255);
  CHECK(srgb8_from_linear(std::numeric_limits<float>::infinity()) == 255);
}

}  // namespace photile::test
