// PNGs that photile writes.
#include <OpenImageIO/imageio.h>

#include <limits>

#include "picture_support.hpp"

namespace photile::test {
namespace {

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

}  // namespace

TEST_CASE("a PNG holds the codes of its values, and the ends for those outside the range") {
  using Limits = std::numeric_limits<float>;
  // IEC 61966-2-1: codes 1 and 254, and 127 beside 128, which meet at 0.21404.
  const std::vector<unsigned char> codes =
      written_codes({-1.0f, Limits::quiet_NaN(), -Limits::infinity(), 0.000303527f, 0.2139f,
                     0.2142f, 0.9911021f, 1.0f, 2.0f, Limits::infinity()});
  CHECK(codes == std::vector<unsigned char>{0, 0, 0, 1, 127, 128, 254, 255, 255, 255});
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
