// PNGs that photile writes.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <limits>

#include "picture_support.hpp"

namespace photile::test {
namespace {

using OIIO::TypeDesc;

/// The 8-bit values that a PNG of one row holds.
std::vector<unsigned char> written_codes(const std::vector<float>& linear) {
  const TemporaryFolder folder;
  Image image;
  image.width = static_cast<int>(linear.size());
  image.height = 1;
  image.add("R") = linear;
  image.add("G") = linear;
  image.add("B") = linear;
  write_png(folder / "a.png", image);
  const auto input = OIIO::ImageInput::open((folder / "a.png").string());
  REQUIRE(input);
  REQUIRE(input->spec().nchannels == 3);
  REQUIRE(input->spec().format == OIIO::TypeDesc::UINT8);
  std::vector<unsigned char> texels(3 * linear.size());
  REQUIRE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, texels.data()));
  std::vector<unsigned char> codes;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    CHECK(texels[3 * i] == texels[3 * i + 1]);
    CHECK(texels[3 * i] == texels[3 * i + 2]);
    codes.push_back(texels[3 * i]);
  }
  return codes;
}

/// IEC 61966-2-1, from encoded to linear: the inverse of what the writer computes.
double decoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

TEST_CASE("a PNG holds the nearest sRGB code of every linear value") {
  std::vector<float> linear;
  std::vector<int> expected;
  for (int code = 0; code < 256; ++code) {
    for (const double offset : {-0.49, 0.0, 0.49}) {  // just inside the code's interval
      const double encoded = (code + offset) / 255.0;
      if (encoded < 0.0 || encoded > 1.0) continue;
      linear.push_back(static_cast<float>(decoded(encoded)));
      expected.push_back(code);
    }
  }
  const std::vector<unsigned char> codes = written_codes(linear);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    INFO("linear " << linear[i]);
    CHECK(int{codes[i]} == expected[i]);
  }
}

TEST_CASE("values outside [0,1] and NaN are clamped in a PNG") {
  using Limits = std::numeric_limits<float>;
  const std::vector<unsigned char> codes = written_codes(
      {-1.0f, Limits::quiet_NaN(), -Limits::infinity(), 2.0f, Limits::infinity(), 1.0f});
  CHECK(codes == std::vector<unsigned char>{0, 0, 0, 255, 255, 255});
}

TEST_CASE("a PNG has the same bytes each time and names no time") {
  const TemporaryFolder folder;
  Image image;
  image.width = image.height = 2;
  for (const char* name : {"R", "G", "B"}) image.add(name);
  write_png(folder / "a.png", image);
  write_png(folder / "b.png", image);
  CHECK(bytes_of(folder / "a.png") == bytes_of(folder / "b.png"));
  CHECK(bytes_of(folder / "a.png").find("tIME") == std::string::npos);
}

}  // namespace photile::test
