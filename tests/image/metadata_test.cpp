// What picture files say of their pixels beside them: exposures, orientations, windows, curves and
// primaries, as the formats define them.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <zlib.h>

#include <array>
#include <functional>

#include "image/picture_metadata.hpp"
#include "oiio_pictures.hpp"
#include "photile/image.hpp"
#include "photile/scene.hpp"
#include "picture_support.hpp"
#include "srgb_oracle.hpp"

namespace photile::test {
namespace {

using namespace std::string_literals;

std::vector<float> light_of(const std::string& name, const std::string& bytes) {
  return opened(name, bytes)->light();
}

/// Pixels of mantissas (r, g, b), times 2^-8 by their exponent 128.
std::string radiance(const std::string& lines, const std::string& size,
                     const std::vector<std::array<int, 3>>& pixels,
                     const std::string& format = "32-bit_rle_rgbe") {
  std::string text = "#?RADIANCE\n" + lines + "FORMAT=" + format + "\n\n" + size + "\n";
  for (const auto& [r, g, b] : pixels) {
    for (const int byte : {r, g, b, 128}) text += static_cast<char>(byte);
  }
  return text;
}

float value(int mantissa) { return static_cast<float>(mantissa) / 256; }

std::string big_endian(std::uint32_t number) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift);
  return text;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body +
         big_endian(static_cast<std::uint32_t>(sum));
}

std::string deflated(const std::string& data) {
  uLongf size = compressBound(data.size());
  std::string result(size, '\0');
  REQUIRE(compress(reinterpret_cast<Bytef*>(result.data()), &size,
                   reinterpret_cast<const Bytef*>(data.data()), data.size()) == Z_OK);
  result.resize(size);
  return result;
}

/// A PNG of one pixel with these chunks before it.
std::string png(const std::array<int, 3>& pixel, const std::string& chunks) {
  std::string row(1, '\0');
  for (const int byte : pixel) row += static_cast<char>(byte);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", big_endian(1) + big_endian(1) + "\x8\x2\0\0\0"s) +
         chunks + chunk("IDAT", deflated(row)) + chunk("IEND", "");
}

std::string fixed(double number) {
  return big_endian(static_cast<std::uint32_t>(std::lround(number * 65536)));
}

/// An ICC profile of D50 colorants and one curve for all channels.
std::string profile(const std::array<std::array<double, 3>, 3>& colorants,
                    const std::string& curve) {
  std::string tags, data;
  constexpr std::size_t count = 6, begin = 128 + 4 + 12 * count;
  const auto add = [&](const std::string& name, const std::string& content) {
    tags += name + big_endian(static_cast<std::uint32_t>(begin + data.size())) +
            big_endian(static_cast<std::uint32_t>(content.size()));
    data += content;
  };
  for (int c = 0; c < 3; ++c) {
    const auto& xyz = colorants[static_cast<std::size_t>(c)];
    add("rgb"[c] + "XYZ"s, "XYZ \0\0\0\0"s + fixed(xyz[0]) + fixed(xyz[1]) + fixed(xyz[2]));
    add("rgb"[c] + "TRC"s, curve);
  }
  return std::string(16, '\0') + "RGB XYZ " + std::string(104, '\0') + big_endian(count) + tags +
         data;
}

/// Display P3 in D50 (its profile's colorants), and sRGB.
constexpr std::array<std::array<double, 3>, 3> p3{
    {{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}}};
constexpr std::array<std::array<double, 3>, 3> srgb{
    {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.7141}}};
/// sRGB's curve, as a parametric one of ISO 15076-1.
std::string srgb_curve() {
  return "para\0\0\0\0\0\3\0\0"s + fixed(2.4) + fixed(1 / 1.055) + fixed(0.055 / 1.055) +
         fixed(1 / 12.92) + fixed(0.04045);
}

TEST_CASE("pixels of a Radiance picture are divided by all its exposures and corrections") {
  const std::vector<std::array<int, 3>> grey{{128, 128, 128}};
  const auto pixel = [&](const std::string& lines) {
    return light_of("a.hdr", radiance(lines, "-Y 1 +X 1", grey));
  };
  const float half = value(128);
  CHECK(pixel("")[0] == half);
  CHECK(pixel("EXPOSURE=2\nEXPOSURE= 5.0\n")[0] == Approx(half / 10));
  CHECK(pixel("EXPOSURE=1e-1\r\n")[2] == Approx(half * 10));
  const std::vector<float> corrected = pixel("COLORCORR= 2 4 8\nCOLORCORR=1 1 2\nEXPOSURE=2\n");
  CHECK(corrected[0] == Approx(half / 4));
  CHECK(corrected[1] == Approx(half / 8));
  CHECK(corrected[2] == Approx(half / 32));
  // Those of a picture that this one was made of, and what changes no pixel's light.
  CHECK(pixel("\tEXPOSURE=2\nPIXASPECT=2\nSOFTWARE= EXPOSURE=2\n")[0] == half);
  for (const char* line : {"EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=bright\n", "EXPOSURE=\n",
                           "EXPOSURE=inf\n", "COLORCORR=1 2\n", "GAMMA=2.2\n"}) {
    CAPTURE(line);
    CHECK_THROWS_AS(pixel(line), image::DecodeError);
  }
}

TEST_CASE("each of the eight resolution strings of a Radiance picture places its pixels") {
  // The upright picture, rows from the top:  10 20 30
  //                                          40 50 60
  const auto at = [](int x, int y) { return 10 * (3 * y + x + 1); };
  for (const bool by_rows : {true, false}) {
    for (const char y_sign : {'-', '+'}) {
      for (const char x_sign : {'+', '-'}) {
        // Y counts upwards (filefmts): -Y begins with the top row, +X with the left column.
        std::vector<std::array<int, 3>> stored;
        const int outer = by_rows ? 2 : 3, inner = by_rows ? 3 : 2;
        for (int i = 0; i < outer; ++i) {
          for (int j = 0; j < inner; ++j) {
            const int along_y = by_rows ? i : j, along_x = by_rows ? j : i;
            const int mantissa =
                at(x_sign == '+' ? along_x : 2 - along_x, y_sign == '-' ? along_y : 1 - along_y);
            stored.push_back({mantissa + 128, 0, 0});
          }
        }
        const std::string y = std::string(1, y_sign) + "Y 2", x = std::string(1, x_sign) + "X 3";
        const std::string size = by_rows ? y + " " + x : x + " " + y;
        CAPTURE(size);
        const std::string bytes = radiance("", size, stored);
        const auto picture = opened("a.hdr", bytes);
        REQUIRE(picture->shape().width == 3);
        REQUIRE(picture->shape().height == 2);
        const std::vector<float> light = picture->light();
        for (std::size_t i = 0; i < 6; ++i) {
          CHECK(light[3 * i] == value(10 * (static_cast<int>(i) + 1) + 128));
        }
      }
    }
  }
  CHECK_THROWS_AS(light_of("a.hdr", radiance("", "-Y 1 +Y 1", {{1, 1, 1}})), image::DecodeError);
}

TEST_CASE("a Radiance picture in XYZ has the luminance of its Y, in cd/m2") {
  const std::string bytes =
      radiance("EXPOSURE=2\n", "-Y 1 +X 2", {{200, 200, 200}, {100, 180, 60}}, "32-bit_rle_xyze");
  const auto picture = opened("a.hdr", bytes);
  CHECK(picture->metadata().white_luminance == 1);
  const std::vector<float> light = picture->light();
  const auto rgb = [&](std::size_t i) { return glm::dvec3(light[i], light[i + 1], light[i + 2]); };
  CHECK(luminance(rgb(0)) == Approx(value(200) / 2));
  CHECK(light[0] == Approx(light[2]));  // white
  // Rec.709's weights have four digits.
  CHECK(luminance(rgb(3)) == Approx(value(180) / 2).epsilon(1e-4));
}

TEST_CASE("primaries become Rec.709's with the luminance that they had") {
  // Rec.2020: its luminances of red, green and blue are those of ITU-R BT.2020.
  const std::string lines = "PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n";
  const std::array<double, 3> weights{0.2627, 0.6780, 0.0593};
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<int, 3> pixel{0, 0, 0};
    pixel[c] = 200;
    const auto light = light_of("a.hdr", radiance(lines, "-Y 1 +X 1", {pixel}));
    CHECK(luminance(glm::dvec3(light[0], light[1], light[2])) ==
          Approx(weights[c] * value(200)).epsilon(1e-3));
    CHECK(std::min({light[0], light[1], light[2]}) >= 0);
  }
  // ITU-R BT.2087: a grey stays, and a colour within both has this Rec.709.
  const auto inside = light_of("a.hdr", radiance(lines, "-Y 1 +X 1", {{160, 160, 128}}));
  CHECK(inside[0] == Approx(value(160) + 0.0728 * value(32)).epsilon(1e-3));
  CHECK(inside[1] == Approx(value(160) + 0.0083 * value(32)).epsilon(1e-3));
  CHECK(inside[2] == Approx(value(160) - 1.1187 * value(32)).epsilon(1e-3));
  CHECK_THROWS_AS(
      light_of("a.hdr", radiance("PRIMARIES=1 1 1 1 1 1 1 1\n", "-Y 1 +X 1", {{1, 1, 1}})),
      image::DecodeError);
}

/// An EXR of the data window, whose pixels are 1, 2, 3, ... in rows, in each of the channels.
void write_window(const std::filesystem::path& file, const Imath::Box2i& display,
                  const Imath::Box2i& data, const std::vector<std::string>& channels,
                  const std::function<void(Imf::Header&)>& change = {}) {
  Imf::Header header(display, data);
  for (const std::string& name : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  if (change) change(header);
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  std::vector<float> pixels;
  for (int i = 0; i < width * height; ++i) pixels.push_back(static_cast<float>(i + 1));
  Imf::FrameBuffer buffer;
  for (const std::string& name : channels) {
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, pixels.data(), data));
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(height);
}

const std::vector<std::string> rgb_channels{"R", "G", "B"};

TEST_CASE("the pixels of an EXR lie in its display window") {
  const TemporaryFolder folder;
  const Imath::Box2i display({0, 0}, {3, 2});
  // A crop: the rest is black.
  write_window(folder / "crop.exr", display, {{1, 1}, {2, 2}}, rgb_channels);
  const Image crop = read_image(folder / "crop.exr");
  REQUIRE(crop.width == 4);
  REQUIRE(crop.height == 3);
  CHECK(*crop.find("G") == std::vector<float>{0, 0, 0, 0, 0, 1, 2, 0, 0, 3, 4, 0});
  // More than is shown, beyond each border.
  write_window(folder / "over.exr", display, {{-1, -1}, {4, 3}}, rgb_channels);
  CHECK(*read_image(folder / "over.exr").find("R") ==
        std::vector<float>{8, 9, 10, 11, 14, 15, 16, 17, 20, 21, 22, 23});
  // A window that does not begin at 0, and one beside what is shown.
  write_window(folder / "moved.exr", {{10, 20}, {11, 20}}, {{10, 20}, {11, 20}}, rgb_channels);
  CHECK(*read_image(folder / "moved.exr").find("B") == std::vector<float>{1, 2});
  write_window(folder / "beside.exr", {{0, 0}, {1, 0}}, {{5, 0}, {6, 0}}, rgb_channels);
  CHECK(*read_image(folder / "beside.exr").find("B") == std::vector<float>{0, 0});
  CHECK(light_of("a.exr", bytes_of(folder / "crop.exr"))[3 * 5 + 1] == 1);
}

TEST_CASE("an EXR's chromaticities, white luminance and projection are taken") {
  const TemporaryFolder folder;
  const Imath::Box2i window({0, 0}, {1, 0});
  write_window(folder / "aces.exr", window, window, {"R", "G", "B", "lamp.R", "lamp.G", "lamp.B"},
               [](Imf::Header& header) {
                 // SMPTE ST 2065-1, whose grey is another white.
                 header.insert("chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities(
                                                     {0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f},
                                                     {0.32168f, 0.33767f})));
                 header.insert("whiteLuminance", Imf::FloatAttribute(80));
               });
  const Image aces = read_image(folder / "aces.exr");
  for (const char* channel : {"R", "G", "B", "lamp.R", "lamp.G", "lamp.B"}) {
    CHECK((*aces.find(channel))[1] == Approx(2).epsilon(1e-5));
  }
  const std::string bytes = bytes_of(folder / "aces.exr");
  CHECK(opened("a.exr", bytes)->metadata().white_luminance == 80);
  write_window(
      folder / "cube.exr", {{0, 0}, {0, 5}}, {{0, 0}, {0, 5}}, rgb_channels,
      [](Imf::Header& header) { header.insert("envmap", Imf::EnvmapAttribute(Imf::ENVMAP_CUBE)); });
  const std::string cube = bytes_of(folder / "cube.exr");
  CHECK(opened("a.exr", cube)->metadata().projection == "a cube map");
}

TEST_CASE("the picture of an EXR is its R, G and B, or Y, or its one layer") {
  const TemporaryFolder folder;
  const Imath::Box2i window({0, 0}, {0, 0});
  const auto channels_of = [&](const std::vector<std::string>& channels) {
    write_window(folder / "a.exr", window, window, channels);
    const std::string bytes = bytes_of(folder / "a.exr");
    return opened("a.exr", bytes)->shape().channels;
  };
  CHECK(channels_of({"A", "B", "G", "R", "Z"}) == 4);
  CHECK(channels_of({"Y"}) == 1);
  CHECK(channels_of({"A", "Y", "Z"}) == 2);
  CHECK(channels_of({"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Normal.X",
                     "View.Normal.Y", "View.Normal.Z"}) == 3);
  CHECK_THROWS_WITH(channels_of({"X", "Y2", "Z"}), Catch::Contains("X, Y2, Z"));
  CHECK_THROWS_AS(channels_of({"BY", "RY", "Y"}), image::DecodeError);
}

TEST_CASE("rows of a PFM come from the bottom, and the magnitude of its scale multiplies") {
  // 1 below 3, as IEEE 754 has them.
  const std::string one = "\x3F\x80\0\0"s, three = "\x40\x40\0\0"s;
  const std::string big = "Pf\n1 2\n2.0\n" + one + three;
  CHECK(light_of("a.pfm", big) == std::vector<float>{6, 2});
  const auto reversed = [](std::string text) { return std::string(text.rbegin(), text.rend()); };
  const std::string little =
      "PF\n1 2\n-1.0\n" + reversed(one + one + one) + reversed(three + three + three);
  CHECK(light_of("a.pfm", little) == std::vector<float>{3, 3, 3, 1, 1, 1});
  for (std::size_t bytes = 0; bytes < big.size(); ++bytes) {
    CAPTURE(bytes);
    CHECK_THROWS_AS(light_of("a.pfm", big.substr(0, bytes)), image::DecodeError);
  }
}

TEST_CASE("the orientation that EXIF names turns a picture upright") {
  // Where the first row and the first column lie, of a picture of 2 x 1 pixels upright or turned.
  for (const char* name : {"a.jpg", "a.tif", "a.png"}) {
    for (int orientation = 1; orientation <= 8; ++orientation) {
      CAPTURE(name, orientation);
      const TemporaryFolder folder;
      // Stored: black on the left, white on the right.
      OIIO::ImageSpec spec(16, 8, 3, OIIO::TypeDesc::UINT8);
      spec["Orientation"] = orientation;
      std::vector<unsigned char> texels;
      for (int i = 0; i < 16 * 8 * 3; ++i) texels.push_back(i / 3 % 16 < 8 ? 0 : 255);
      write_by_oiio(folder / name, spec, texels);
      std::string bytes = bytes_of(folder / name);
      if (name == std::string("a.png")) {  // its writer has no such chunk
        const std::string exif = "MM\0*\0\0\0\x8\0\1\x1\x12\0\3\0\0\0\1\0"s +
                                 static_cast<char>(orientation) + "\0\0\0\0\0\0"s;
        bytes.insert(33, chunk("eXIf", exif));
      }
      const auto picture = opened(name, bytes);
      const bool turned = orientation > 4;
      REQUIRE(picture->shape().width == (turned ? 8 : 16));
      const std::vector<float> light = picture->light();
      // EXIF 2.3, table 6: the 0th column is on the left (1, 4), right (2, 3), top (5, 6) or
      // bottom (7, 8).
      const bool starts_black =
          orientation == 1 || orientation == 4 || orientation == 5 || orientation == 6;
      CHECK(light.front() == Approx(starts_black ? 0 : 1).margin(0.02));
      CHECK(light.back() == Approx(starts_black ? 1 : 0).margin(0.02));
    }
  }
}

TEST_CASE("the colours of a PNG are those that its chunks name") {
  const std::array<int, 3> pixel{188, 100, 50};
  const auto light = [&](const std::string& chunks) {
    return light_of("a.png", png(pixel, chunks));
  };
  const std::string plain = chunk("gAMA", big_endian(100'000)),
                    square = chunk("gAMA", big_endian(50'000));
  CHECK(light("")[0] == Approx(linear(188)));
  CHECK(light(plain)[0] == Approx(188 / 255.0));
  CHECK(light(square)[1] == Approx(std::pow(100 / 255.0, 2)));
  CHECK(light(chunk("sRGB", "\0"s) + square)[1] == Approx(linear(100)));
  // Primaries of Rec.2020: the weights of its luminance.
  std::string chromaticities;
  for (const int xy : {31'270, 32'900, 70'800, 29'200, 17'000, 79'700, 13'100, 4'600}) {
    chromaticities += big_endian(static_cast<std::uint32_t>(xy));
  }
  const auto wide = light(plain + chunk("cHRM", chromaticities));
  const double truth = (0.2627 * 188 + 0.6780 * 100 + 0.0593 * 50) / 255;
  CHECK(luminance(glm::dvec3(wide[0], wide[1], wide[2])) == Approx(truth).epsilon(1e-3));
  // A profile of Display P3 counts before both: its luminances under D50 and D65 are those of
  // SMPTE EG 432-1.
  const std::string curve = "curv\0\0\0\0\0\0\0\0"s;
  const auto by_profile =
      light(plain + chunk("iCCP", "P3\0\0"s + deflated(profile(p3, curve))) + square);
  const double p3_truth = (0.22897 * 188 + 0.69174 * 100 + 0.07929 * 50) / 255;
  CHECK(luminance(glm::dvec3(by_profile[0], by_profile[1], by_profile[2])) ==
        Approx(p3_truth).epsilon(2e-3));
  // And cICP before that: Display P3 in sRGB's curve.
  const auto coded = light(chunk("cICP", "\xC\xD\0\1"s) + plain);
  const double coded_truth = 0.22897 * linear(188) + 0.69174 * linear(100) + 0.07929 * linear(50);
  CHECK(luminance(glm::dvec3(coded[0], coded[1], coded[2])) == Approx(coded_truth).epsilon(1e-3));
  CHECK_THROWS_WITH(light(chunk("cICP", "\x9\x10\0\1"s)), Catch::Contains("transfer curve 16"));
  CHECK_THROWS_WITH(light(chunk("iCCP", "x\0\0"s + deflated("no profile"))),
                    Catch::Contains("ICC profile"));
}

TEST_CASE("sRGB's own profile is sRGB, and changes no bit") {
  const auto space = image::icc_space(span_of(profile(srgb, srgb_curve())));
  CHECK(space.is_srgb());
  CHECK_FALSE(image::icc_space(span_of(profile(p3, srgb_curve()))).is_srgb());
}

TEST_CASE("colours that are no RGB are refused by their name") {
  const TemporaryFolder folder;
  write_by_oiio(folder / "a.tif", OIIO::ImageSpec(1, 1, 3, OIIO::TypeDesc::UINT8),
                std::vector<unsigned char>{1, 2, 3});
  std::string bytes = bytes_of(folder / "a.tif");
  const auto entry = image::tiff_entry(span_of(bytes), 262);
  REQUIRE(entry);
  bytes[*entry + 8] = 8;  // CIE L*a*b*
  CHECK_THROWS_WITH(opened("a.tif", bytes), Catch::Contains("L*a*b*"));
}

}  // namespace
}  // namespace photile::test
