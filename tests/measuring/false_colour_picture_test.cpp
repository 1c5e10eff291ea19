// Pictures in false colour: known lux and cd/m2 in known colours.
#include <array>
#include <catch2/catch.hpp>

#include "image/display.hpp"
#include "photile/errors.hpp"
#include "report/false_colour.hpp"
#include "report/palette.hpp"
#include "report/sheet.hpp"
#include "report/tables.hpp"

namespace photile::test {
namespace {

using Colour = std::array<std::uint8_t, 3>;

/// Two pixels, two lights at power 1: lux (or W/m2) 3 and 0 by the first, 1 and 2 by the second.
LightLayers two_pixels() {
  LightLayers layers(2, 1, {"a", "b"});
  layers.layers[0].radiance = {glm::vec3(1), glm::vec3(0)};
  layers.layers[0].illuminance = {3, 0};
  layers.layers[1].radiance = {glm::vec3(0.5f), glm::vec3(0, 2, 0)};
  layers.layers[1].illuminance = {1, 2};
  return layers;
}

LightMix mix_of(double a, double b, PowerUnit unit = PowerUnit::lumen) {
  LightMix mix;
  mix.lights.resize(2);
  mix.lights[0].name = "a";
  mix.lights[0].power = a;
  mix.lights[1].name = "b";
  mix.lights[1].power = b;
  for (MixedLight& light : mix.lights) light.unit = unit;
  return mix;
}

/// A black picture.
Image black(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* channel : {"R", "G", "B"}) image.add(channel);
  return image;
}

Colour colour_at(const Image& picture, int x, int y) {
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = image::srgb8_from_linear(
        picture.channels[c][static_cast<std::size_t>(y * picture.width + x)]);
  }
  return colour;
}

}  // namespace

TEST_CASE("the illuminance of a picture is the sum of its lights' lux") {
  const LightLayers layers = two_pixels();
  CHECK(report::illuminance_of(*mixed_picture(layers, mix_of(10, 100))) ==
        std::vector<float>{130, 200});
  LightMix watts = mix_of(10, 100, PowerUnit::watt);
  watts.lumen_per_watt = 179;
  CHECK(report::illuminance_of(*mixed_picture(layers, watts)) ==
        std::vector<float>{130 * 179, 200 * 179});
}

TEST_CASE("illuminance is read whole where a picture has more rows than are read at a time") {
  constexpr int height = 150;
  LightLayers layers(1, height, {"a", "b"});
  std::vector<float> expected;
  for (int y = 0; y < height; ++y) {
    layers.layers[0].illuminance[static_cast<std::size_t>(y)] = static_cast<float>(y);
    layers.layers[1].illuminance[static_cast<std::size_t>(y)] = 1000;
    expected.push_back(static_cast<float>(1000 + y));
  }
  CHECK(report::illuminance_of(*mixed_picture(layers, mix_of(1, 1))) == expected);
}

TEST_CASE("the luminance of a picture is in cd/m2, of watts by their efficacy") {
  const LightLayers layers = two_pixels();
  // The second pixel: 100 x (0, 2, 0), of which Rec.709's green weighs 0.7152.
  const auto lumens = report::luminance_of(mixed_picture(layers, mix_of(10, 100))->root());
  CHECK(lumens[0] == Approx(60));
  CHECK(lumens[1] == Approx(200 * 0.7152));
  LightMix mix = mix_of(10, 100, PowerUnit::watt);
  mix.lumen_per_watt = 179;
  const auto watts = report::luminance_of(mixed_picture(layers, mix)->root());
  CHECK(watts[0] == Approx(60 * 179));
  CHECK_THROWS_AS(report::luminance_of(black(2, 1)), InputError);  // cd/m2, or what?
}

TEST_CASE("a pixel has the colour that its share of the scale has in the palette") {
  const std::string name = GENERATE("turbo", "def", "viridis");
  const report::Palette palette(name);
  const std::vector<float> lux{0, 125, 250, 500, 499, 5000};
  const Image picture =
      report::false_colour_picture(lux, black(3, 2), {.scale = 500, .palette = name});
  const std::array shares{0.0, 0.25, 0.5, 1.0, 499.0 / 500, 1.0};
  for (int pixel = 0; pixel < 6; ++pixel) {
    INFO("pixel " << pixel);
    CHECK(colour_at(picture, pixel % 3, pixel / 3) ==
          palette.at(shares[static_cast<std::size_t>(pixel)]));
  }
}

TEST_CASE("an automatic scale ends at the largest value that is a number") {
  const std::vector<float> lux{100, 400, std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()};
  const Image picture = report::false_colour_picture(lux, black(4, 1), {.scale = 0});
  const report::Palette palette("turbo");
  CHECK(colour_at(picture, 0, 0) == palette.at(0.25));
  CHECK(colour_at(picture, 1, 0) == palette.at(1));
  CHECK(colour_at(picture, 2, 0) == palette.at(1));
  CHECK(colour_at(picture, 3, 0) == Colour{128, 128, 128});
}

TEST_CASE("a logarithmic scale has its decades below the top") {
  const Image picture =
      report::false_colour_picture(std::vector<float>{10, 100, 1000}, black(3, 1), {.decades = 2});
  const report::Palette palette("turbo");
  CHECK(colour_at(picture, 0, 0) == palette.at(0));
  CHECK(colour_at(picture, 1, 0) == palette.at(0.5));
  CHECK(colour_at(picture, 2, 0) == palette.at(1));
}

TEST_CASE(
    "the legend has a bar for each step, in the colour of its middle, the largest at the top") {
  const int steps = GENERATE(1, 4, 8);
  const std::vector<float> lux(200 * 3, 1);
  const Image picture = report::false_colour_picture(lux, black(3, 200), {.steps = steps});
  CHECK(picture.height == 200);
  const report::Palette palette("turbo");
  constexpr int left = 3 + 12, top = 24;
  for (int step = 0; step < steps; ++step) {
    INFO("step " << step << " of " << steps);
    const double height = (200.0 - top) / steps;
    const int middle = 200 - static_cast<int>((step + 0.5) * height);
    CHECK(colour_at(picture, left, middle) == palette.at((step + 0.5) / steps));
    CHECK(colour_at(picture, left + 19, middle) == palette.at((step + 0.5) / steps));
  }
}

TEST_CASE("beside the legend stand its unit and its values, in a small picture as well") {
  REQUIRE(report::Sheet::has_font());
  const std::vector<float> lux{1};
  const auto drawn = [&](report::FalseColour options) {
    return report::false_colour_picture(lux, black(1, 1), options);
  };
  const Image plain = drawn({});
  CHECK(plain.height >= 8 * report::Sheet::font_size);  // a line for each step
  /// Dark pixels right of the bars, and above them.
  const auto ink = [&](const Image& picture, int first_row, int end_row, int first_column) {
    int count = 0;
    for (int y = first_row; y < end_row; ++y) {
      for (int x = first_column; x < picture.width; ++x) count += colour_at(picture, x, y)[1] < 99;
    }
    return count;
  };
  constexpr int beside = 1 + 12 + 20, top = 24;
  for (int step = 0; step < 8; ++step) {
    CHECK(ink(plain, top + 16 * step, top + 16 * (step + 1), beside) > 10);
  }
  CHECK(ink(plain, 0, top, 1) > 10);
  CHECK(ink(drawn({.label = ""}), 0, top, 1) == 0);
  // The last column is free: nothing is cut off, be the label ever so long.
  for (const std::string label : {"lux", "illuminance of the working plane, lux"}) {
    const Image picture = drawn({.scale = 123456, .label = label});
    CHECK(ink(picture, 0, picture.height, picture.width - 1) == 0);
  }
}

TEST_CASE("isolines lie over the picture") {
  // Levels 250 and 750; a grey picture, 1 x 4 pixels.
  Image grey = black(4, 1);
  for (auto& channel : grey.channels) channel.assign(4, 0.25f);
  const std::vector<float> lux{100, 200, 300, 400};
  const Image picture =
      report::false_colour_picture(lux, grey, {.steps = 2, .contours = report::Contours::lines});
  const Colour background = colour_at(grey, 0, 0);
  CHECK(colour_at(picture, 0, 0) == background);
  CHECK(colour_at(picture, 1, 0) == report::Palette("turbo").at(0.2));  // 250 lies right of it
  CHECK(colour_at(picture, 2, 0) == background);
  CHECK(colour_at(picture, 3, 0) == background);
}

TEST_CASE("numbers of legends and plans have no powers of ten up to a thousand million") {
  CHECK(report::number_text(62.5, 4) == "62.5");
  CHECK(report::number_text(12500, 4) == "12500");
  CHECK(report::number_text(999.6, 3) == "1000");
  CHECK(report::number_text(1234.5, 3) == "1234");
  CHECK(report::number_text(0.06254, 3) == "0.0625");
  CHECK(report::number_text(0, 3) == "0");
  CHECK(report::number_text(3e12, 3) == "3e+12");
}

}  // namespace photile::test
