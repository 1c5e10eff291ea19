// PNGs and pictures of Radiance that photile writes.
#include <OpenImageIO/imageio.h>

#include <glm/gtc/constants.hpp>
#include <limits>

#include "flat_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

Image picture_of(int width, int height, float white_luminance) {
  Image picture = flat_picture(width, height);
  picture.numbers["whiteLuminance"] = white_luminance;
  return picture;
}

std::string header_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text, line;
  while (std::getline(stream, line) && !line.empty()) text += line + "\n";
  return text;
}

TEST_CASE("a Radiance picture keeps luminance: 179 times the bright of its primaries") {
  const float white = GENERATE(1.0f, 683.0f);
  Image picture = picture_of(5, 2, white);
  const glm::vec3 colours[]{
      {1, 1, 1}, {0.5f, 0.2f, 0.1f}, {0, 0, 3e4f}, {1e-6f, 2e-6f, 0}, {0, 0, 0}};
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      picture.channels[c][5 + i] = colours[i][static_cast<int>(c)];  // the lower row
    }
  }
  const TemporaryFolder folder;
  write_hdr(folder.path / "a.hdr", picture);
  const Image read = read_image(folder.path / "a.hdr");
  REQUIRE(read.width == 5);
  REQUIRE(read.height == 2);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK((*read.find("R"))[i] == 0);
    const auto value = [&](const char* channel) {
      return static_cast<double>((*read.find(channel))[5 + i]);
    };
    const double luminance = 179 * (0.265 * value("R") + 0.67 * value("G") + 0.065 * value("B"));
    const double truth =
        white * (0.2126 * colours[i].r + 0.7152 * colours[i].g + 0.0722 * colours[i].b);
    CHECK(luminance == Approx(truth).epsilon(0.012));  // 8 bits, rounded down
    if (colours[i].r > 0) {
      CHECK(value("G") / value("R") == Approx(colours[i].g / colours[i].r).epsilon(0.02));
    }
  }
}

TEST_CASE("the view of a Radiance picture is the camera's") {
  Camera camera;
  camera.position = {1, 2, 3};
  camera.vertical_field_of_view = glm::pi<double>();
  camera.projection = Projection::angular;
  CHECK(radiance_view(camera, 64, 64) == "-vta -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 180 -vv 180");
  camera.projection = Projection::fisheye;
  CHECK(radiance_view(camera, 64, 64) == "-vth -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 180 -vv 180");
  CHECK(radiance_view(camera, 128, 64).empty());  // wider than a hemisphere
  camera.projection = Projection::equirectangular;
  CHECK(radiance_view(camera, 128, 64).empty());
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 3;
  CHECK(radiance_view(camera, 128, 64) == "-vtl -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 6 -vv 3");
  camera.projection = Projection::perspective;
  camera.vertical_field_of_view = 0.5 * glm::pi<double>();
  CHECK(radiance_view(camera, 64, 64) == "-vtv -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 90 -vv 90");

  Image picture = picture_of(64, 64, 1);
  set_camera_attributes(picture, camera, 64, 64);
  const TemporaryFolder folder;
  write_hdr(folder.path / "a.hdr", picture);
  CHECK_THAT(header_of(folder.path / "a.hdr"),
             Catch::Contains("VIEW= -vtv -vp 1 2 3") && Catch::Contains("FORMAT=32-bit_rle_rgbe"));
}

TEST_CASE("a picture of unknown units is not written in Radiance's") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_hdr(folder.path / "a.hdr", flat_picture(2, 2)), InputError);
  CHECK_FALSE(std::filesystem::exists(folder.path / "a.hdr"));
}

// PNGs.

/// The 8-bit values that a PNG of one row holds.
std::vector<unsigned char> written_codes(const std::vector<float>& linear) {
  const TemporaryFolder folder;
  Image image = flat_picture(static_cast<int>(linear.size()), 1);
  for (std::vector<float>& channel : image.channels) channel = linear;
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
  for (const char* name : {"a.png", "b.png"}) write_png(folder / name, flat_picture(2, 2));
  CHECK(bytes_of(folder / "a.png") == bytes_of(folder / "b.png"));
  CHECK(bytes_of(folder / "a.png").find("tIME") == std::string::npos);
}

}  // namespace
}  // namespace photile::test
