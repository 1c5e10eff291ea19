// From radiance to what a display shows.
#include <cmath>
#include <limits>

#include "flat_picture.hpp"
#include "image/display.hpp"
#include "image/glare.hpp"
#include "picture_support.hpp"
#include "report/palette.hpp"
#include "two_lights.hpp"

namespace photile::test {
namespace {

using namespace image;
using namespace report;

void set(Image& image, std::size_t pixel, const glm::vec3& rgb) {
  for (std::size_t c = 0; c < 3; ++c) image.channels[c][pixel] = rgb[static_cast<int>(c)];
}

Image filled(std::size_t pixels, const glm::vec3& rgb) {
  Image image = flat_picture(static_cast<int>(pixels), 1);
  for (std::size_t i = 0; i < pixels; ++i) set(image, i, rgb);
  return image;
}

glm::vec3 at(const Image& image, std::size_t pixel) {
  return {image.channels[0][pixel], image.channels[1][pixel], image.channels[2][pixel]};
}

/// The sRGB curve alone: what is below white stays. By an exposure of its own, and by none.
const ToneMapping standard{.view = DisplayView::standard};
const ToneMapping as_it_is{.automatic_exposure = false, .view = DisplayView::standard};

glm::dvec3 neutral(const glm::vec3& rgb) {
  return glm::dvec3(at(tone_map(filled(1, rgb), {.automatic_exposure = false}), 0));
}

/// Where the middle channel stands between the least and the largest: with their order, the hue.
double hue_within_sextant(const glm::dvec3& rgb) {
  const double least = std::min({rgb.r, rgb.g, rgb.b}), most = std::max({rgb.r, rgb.g, rgb.b});
  return (rgb.r + rgb.g + rgb.b - 2 * least - most) / (most - least);
}

TEST_CASE("automatic exposure brings an even picture to 0.36, whatever its unit") {
  for (const float level : {1e-6f, 0.5f, 3.0e4f}) {
    CHECK(at(tone_map(filled(50, glm::vec3(level)), standard), 7).g == Approx(0.36).epsilon(1e-6));
  }
}

TEST_CASE("pixels that see a lamp, a black background or nothing finite do not set the exposure") {
  Image image = filled(100, glm::vec3(2.0f));
  for (std::size_t i = 0; i < 4; ++i) set(image, i, glm::vec3(1.0e5f));
  for (std::size_t i = 10; i < 20; ++i) set(image, i, glm::vec3(1.0e-4f));
  for (std::size_t i = 20; i < 60; ++i) set(image, i, glm::vec3(0.0f));
  set(image, 60, glm::vec3(std::numeric_limits<float>::infinity()));
  set(image, 61, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  CHECK(at(tone_map(image, standard), 99).r == Approx(0.36).epsilon(1e-6));
}

TEST_CASE("lights over more than a tenth of a picture count, and black faces beside them do not") {
  Image image = filled(100, glm::vec3(1.0f));
  for (std::size_t i = 0; i < 30; ++i) set(image, i, glm::vec3(64.0f));
  // Ten of the thirty are left out, so that the mean is that of 70 and 20 logarithms.
  CHECK(at(tone_map(image, standard), 99).r ==
        Approx(0.36 * std::pow(64, -20.0 / 90)).epsilon(1e-6));
  for (std::size_t i = 30; i < 100; ++i) set(image, i, glm::vec3(0.06f));
  CHECK(at(tone_map(image, standard), 0).r == Approx(0.36).epsilon(1e-6));
}

TEST_CASE("of what is no light a tenth at most is more than 2.5 times as bright as white") {
  Image image = filled(100, glm::vec3(1.0f));
  for (std::size_t i = 0; i < 11; ++i) set(image, i, glm::vec3(16.0f));
  // By the mean of logarithms 1 would become 0.36 x 16^-0.11 = 0.265 and 16 more than 4.
  CHECK(at(tone_map(image, standard), 99).r == Approx(2.5 / 16).epsilon(1e-6));
  set(image, 10, glm::vec3(1.0f));
  CHECK(at(tone_map(image, standard), 99).r == Approx(0.36 * std::pow(16, -0.1)).epsilon(1e-6));
}

TEST_CASE("a stop of exposure doubles, and without automatic exposure values stay") {
  const Image image = filled(4, {0.1f, 0.2f, 0.05f});
  ToneMapping manual = as_it_is;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.1f, 0.2f, 0.05f));
  manual.exposure = 1.0;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.2f, 0.4f, 0.1f));
  ToneMapping automatic = standard;
  automatic.exposure = -2.0;
  CHECK(at(tone_map(filled(4, glm::vec3(9.0f)), automatic), 0).r == Approx(0.09).epsilon(1e-6));
}

TEST_CASE("through the sRGB curve alone a pixel brighter than white is scaled as a whole") {
  const glm::vec3 shown = at(tone_map(filled(1, {8.0f, 4.0f, 2.0f}), as_it_is), 0);
  CHECK(shown == glm::vec3(1.0f, 0.5f, 0.25f));
}

// Expected values by hand from the specification of Khronos PBR Neutral:
// f = x - x^2 / 0.16 of the least channel x up to 0.08, then 0.04; the rest rolls off from 0.76.
TEST_CASE("the neutral view shows colours below its highlights less what a dielectric reflects") {
  for (const glm::vec3& base : {glm::vec3(0.04f), glm::vec3(0.5f, 0.2f, 0.04f),
                                glm::vec3(0.76f, 0.1f, 0.3f), glm::vec3(0.76f)}) {
    CHECK(glm::distance(neutral(base + 0.04f), glm::dvec3(base)) < 1e-6);
  }
}

TEST_CASE("the toe of the neutral view leaves black as it is and meets the rest with one slope") {
  CHECK(neutral(glm::vec3(0.0f)) == glm::dvec3(0.0));
  CHECK(neutral({0.3f, 0.0f, 0.1f}) == glm::dvec3(glm::vec3(0.3f, 0.0f, 0.1f)));
  CHECK(neutral(glm::vec3(0.04f)).g == Approx(0.01).epsilon(1e-5));  // 0.04^2 / 0.16
  CHECK(neutral({0.24f, 0.04f, 0.14f}).r == Approx(0.21).epsilon(1e-5));
  CHECK((neutral(glm::vec3(0.08f)).g - neutral(glm::vec3(0.079f)).g) / 0.001 ==
        Approx(1.0).epsilon(0.01));
}

TEST_CASE("highlights of the neutral view roll off from 0.76 and fade to white") {
  // p = 1: p_n = 1 - 0.24^2 / (1 + 1 - 1.52) = 0.88
  CHECK(neutral(glm::vec3(1.04f)).g == Approx(0.88).epsilon(1e-6));
  // p = 2, p_n = 1 - 0.0576 / 1.48; g = 1 / (0.15 (2 - p_n) + 1) of the colour, the rest white.
  const double peak = 1 - 0.0576 / 1.48, share = 1 / (0.15 * (2 - peak) + 1);
  const glm::dvec3 shown = neutral({2.04f, 1.04f, 0.04f + 0.04f});
  CHECK(shown.r == Approx(peak).epsilon(1e-6));
  CHECK(shown.g == Approx(peak * (share * 0.5 + 1 - share)).epsilon(1e-6));
  CHECK(shown.b == Approx(peak * (share * 0.02 + 1 - share)).epsilon(1e-6));
  CHECK(glm::distance(neutral({1e30f, 1e29f, 0.0f}), glm::dvec3(1.0)) < 1e-6);
}

TEST_CASE("the neutral view keeps order and hue and never exceeds white") {
  glm::dvec3 before(0.0);
  for (double stops = -12; stops <= 12; stops += 0.05) {
    const auto factor = static_cast<float>(std::exp2(stops));
    const glm::dvec3 shown = neutral(factor * glm::vec3(1.0f, 0.4f, 0.1f));
    CHECK(glm::all(glm::greaterThan(shown, before)));
    CHECK(glm::all(glm::lessThan(shown, glm::dvec3(1.0))));
    CHECK(hue_within_sextant(shown) == Approx(1.0 / 3).epsilon(2e-4));
    before = shown;
  }
}

TEST_CASE("a pixel on the border of a lamp shows the part of it that the lamp fills") {
  // Columns: a wall, a border that the lamp fills by a quarter, and the lamp.
  const double wall = 0.2, lamp = 16, border = 0.75 * wall + 0.25 * lamp;
  Image image = flat_picture(3, 2);
  for (std::size_t y = 0; y < 2; ++y) {
    set(image, 3 * y, glm::vec3(static_cast<float>(wall)));
    set(image, 3 * y + 1, glm::vec3(static_cast<float>(border)));
    set(image, 3 * y + 2, glm::vec3(static_cast<float>(lamp)));
  }
  const Image shown = tone_map(image, as_it_is);
  CHECK(at(shown, 1).g == Approx(0.75 * wall + 0.25).epsilon(1e-5));
  CHECK(at(shown, 0).g == Approx(wall));
  CHECK(at(shown, 2).g == 1.0f);
  // Without a lamp beside them bright pixels are white.
  for (std::size_t y = 0; y < 2; ++y) set(image, 3 * y + 2, glm::vec3(3.9f));
  CHECK(at(tone_map(image, as_it_is), 1).g == 1.0f);
}

TEST_CASE("tone mapping gives values in [0,1] for every float") {
  using Limits = std::numeric_limits<float>;
  const std::vector<float> awkward({0.0f, -0.0f, 1.0f, -5.0f, Limits::max(), Limits::lowest(),
                                    Limits::denorm_min(), Limits::infinity(), -Limits::infinity(),
                                    Limits::quiet_NaN()});
  std::vector<glm::vec3> colors;
  for (const float r : awkward) {
    for (const float g : awkward) {
      for (const float b : awkward) colors.emplace_back(r, g, b);
    }
  }
  Image image = filled(colors.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i < colors.size(); ++i) set(image, i, colors[i]);
  for (const double exposure : {0.0, 3000.0, -3000.0}) {
    for (const bool automatic : {true, false}) {
      for (const DisplayView view : all_display_views) {
        const Image shown = tone_map(image, {automatic, exposure, view});
        bool in_range = true;
        for (const std::vector<float>& plane : shown.channels) {
          for (const float value : plane) in_range = in_range && value >= 0.0f && value <= 1.0f;
        }
        CHECK(in_range);
      }
    }
  }
}

TEST_CASE("a black picture stays black, and one without R, G, B is an input error") {
  CHECK(at(tone_map(filled(3, glm::vec3(0.0f)), {}), 1) == glm::vec3(0.0f));
  CHECK_THROWS_AS(tone_map(Image{}, {}), InputError);
  CHECK_THROWS_AS(tone_map(filled(3, glm::vec3(0.0f)), {true, NAN}), UsageError);
}

/// The definition: the nearest code of the encoded value.
int nearest_code(float linear) {
  return static_cast<int>(std::lround(255.0 * srgb_from_linear(linear)));
}

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

// The palettes of Radiance's falsecolor, from its formulas and tables.

void check_near(const glm::dvec3& is, double r, double g, double b) {
  CHECK(is.r == Approx(r).margin(1e-6));
  CHECK(is.g == Approx(g).margin(1e-6));
  CHECK(is.b == Approx(b).margin(1e-6));
}

TEST_CASE("Radiance's palettes have its colours") {
  // Ends and an entry of the table in def: 0.0454545 x 10.
  check_near(report::palette_colour("def", 0), 0.18848, 0.0009766, 0.2666);
  check_near(report::palette_colour("def", 0.454545), 0.1739422, 0.2629843, 0.08564082);
  check_near(report::palette_colour("def", 0.5 * 0.0454545), (0.18848 + 0.05468174) / 2,
             (0.0009766 + 2.35501e-05) / 2, (0.2666 + 0.3638662) / 2);
  // spec: 1.6 x - 0.6, clipped; both branches of green meet at 0.375.
  check_near(report::palette_colour("spec", 0), 0, 0, 1);
  check_near(report::palette_colour("spec", 0.375), 0, 1, 0);
  check_near(report::palette_colour("spec", 1), 1, 0, 0);
  // The others are sRGB-like values to the power of 2.2.
  check_near(report::palette_colour("pm3d", 0.25), std::pow(0.5, 2.2), std::pow(1.0 / 64, 2.2), 1);
  check_near(report::palette_colour("hot", 0.5), 1, std::pow(0.5, 2.2), 0);
  check_near(report::palette_colour("eco", 0.25), std::pow(0.5, 2.2), 0, std::pow(0.5, 2.2));
}

TEST_CASE("every palette that is named can be used") {
  for (const std::string& name : report::Palette::names()) {
    INFO(name);
    const report::Palette palette(name);
    CHECK(palette.at(0) != palette.at(1));
  }
  CHECK(report::Palette("hot").hex(1) == "#ffffff");
  CHECK(report::Palette("eco").hex(0) == "#0000ff");
}

// Which reflections are marked.

/// Two lights over four pixels, whose pictures are even at `radiance` and power 1.
LightLayers even(float a, float b) {
  LightLayers layers(4, 1, {"a", "b"});
  layers.layers[0].radiance.assign(4, glm::vec3(a));
  layers.layers[1].radiance.assign(4, glm::vec3(b));
  return layers;
}

LightMix mix_of(double a, double b) { return two_lights("a", a, "b", b); }

TEST_CASE("a limit up to 100 counts in mean luminances of the picture, above in cd/m2") {
  const LightLayers none = even(0, 0);
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 5).limit == Approx(5 * 320));
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 100).limit == Approx(100 * 320));
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 101).limit == 101);
}

TEST_CASE("each pixel is marked with the light whose reflection is brightest above the limit") {
  LightLayers reflections = even(0, 0);
  reflections.layers[0].radiance[0] = glm::vec3(300);  // x 1: above
  reflections.layers[1].radiance[0] = glm::vec3(400);  // x 0.5: above, but less
  reflections.layers[1].radiance[1] = glm::vec3(500);  // x 0.5: above
  reflections.layers[0].radiance[2] = glm::vec3(199);  // below
  const Glare glare = find_glare(even(1, 1), reflections, mix_of(1, 0.5), 199.5);
  CHECK(glare.marks == std::vector<int>{0, 1, -1, -1});
  CHECK(glare.lights[0].fraction == Approx(0.25));
  CHECK(glare.lights[1].fraction == Approx(0.5));
  CHECK(glare.lights[0].peak == Approx(300));
  CHECK(glare.lights[1].peak == Approx(250));
  CHECK(glare_lines(glare, PowerUnit::lumen).size() == 2);
}

TEST_CASE("marks have their light's colour, the rest is dimmed") {
  std::vector<std::uint8_t> rgb{200, 100, 50, 1, 2, 3};
  draw_marks({-1, 1}, rgb);
  const auto colour = mark_colour(1);
  CHECK(rgb == std::vector<std::uint8_t>{100, 50, 25, colour[0], colour[1], colour[2]});
  CHECK(mark_colour(0) != mark_colour(6));
  CHECK(mark_colour(0) == mark_colour(7));
}

TEST_CASE("glare of pictures of different sizes is refused") {
  CHECK_THROWS_AS(find_glare(even(1, 1), LightLayers(2, 2, {"a", "b"}), mix_of(1, 1), 5),
                  UsageError);
}

constexpr int side = 32;

Image grey(float value) { return flat_picture(side, side, value); }

void scale(Image& image, float factor) {
  for (auto& plane : image.channels) {
    for (float& value : plane) value *= factor;
  }
}

TEST_CASE("a picture that is brighter by a factor has the errors that follow from it") {
  const Image reference = grey(2.0f);
  Image picture = reference;
  scale(picture, 1.1f);
  const PictureError error = picture_error(picture, reference);
  // ((1.1 - 1) x 2)^2 / (2^2 + 0.01 x 2^2)
  CHECK(error.relative_mse == Approx(0.01 / 1.01).epsilon(1e-5));
  CHECK(error.mean_ratio == Approx(1.1).epsilon(1e-6));
  CHECK(error.worst_region == Approx(0.1).epsilon(1e-5));
  // Displayed as 0.18 and 0.198, where white is 1.
  CHECK(error.psnr == Approx(-20 * std::log10(0.018)).epsilon(1e-4));
}

TEST_CASE("equal pictures have no error") {
  const Image picture = grey(0.3f);
  const PictureError error = picture_error(picture, picture);
  CHECK(error.relative_mse == 0);
  CHECK(error.mean_ratio == 1);
  CHECK(error.worst_region == 0);
  CHECK(std::isinf(error.psnr));
}

TEST_CASE("noise averages out of regions and of the mean, and stays in the relative error") {
  const Image reference = grey(1.0f);
  Image picture = reference;
  for (auto& plane : picture.channels) {
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane[i] += (i + i / side) % 2 == 0 ? 0.2f : -0.2f;
  }
  const PictureError error = picture_error(picture, reference);
  CHECK(error.relative_mse == Approx(0.04 / 1.01).epsilon(1e-5));
  CHECK(error.mean_ratio == Approx(1).epsilon(1e-6));
  CHECK(error.worst_region < 1e-6);
}

TEST_CASE("one wrong region is the worst region") {
  const Image reference = grey(1.0f);
  Image picture = reference;
  for (auto& plane : picture.channels) {
    for (int y = 0; y < 2; ++y) {  // a tile of a sixteenth of the height
      for (int x = 4; x < 6; ++x) plane[static_cast<std::size_t>(y * side + x)] = 0.5f;
    }
  }
  const PictureError error = picture_error(picture, reference);
  CHECK(error.worst_region == Approx(0.5).epsilon(1e-6));
  CHECK(error.worst_area.x == 4);
  CHECK(error.worst_area.y == 0);
  CHECK(error.worst_area.width == 2);
  CHECK(error.worst_area.height == 2);
}

TEST_CASE("pixels that see a lamp in the reference do not count, nor do those next to them") {
  Image reference = grey(1.0f), picture = grey(1.0f);
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * side + x); };
  for (auto& plane : reference.channels) plane[at(5, 7)] = 1000.0f;
  for (auto& plane : picture.channels) plane[at(6, 8)] = 30.0f;  // the lamp's border
  CHECK(picture_error(picture, reference).relative_mse == 0);
  CHECK(picture_error(picture, reference).mean_ratio == 1);
  for (auto& plane : picture.channels) plane[at(7, 8)] = 30.0f;  // beyond
  CHECK(picture_error(picture, reference).relative_mse > 0.5);
}

TEST_CASE("a region that mostly sees lamps is never the worst") {
  Image reference = grey(1.0f), picture = grey(1.0f);
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * side + x); };
  // Of the tile of 2 x 2 pixels at (6, 6) the borders of two lamps leave one pixel.
  for (auto& plane : reference.channels) plane[at(5, 7)] = plane[at(8, 8)] = 1000.0f;
  for (auto& plane : picture.channels) plane[at(7, 6)] = 30.0f;
  CHECK(picture_error(picture, reference).worst_region == 0);
}

TEST_CASE("pictures that cannot be compared are refused") {
  const Image reference = grey(1.0f);
  CHECK_THROWS_AS(picture_error(flat_picture(side / 2, side, 1), reference), UsageError);
  CHECK_THROWS_AS(picture_error(flat_picture(side, side, 1, {}), reference), UsageError);
  CHECK_THROWS_AS(picture_error(reference, grey(0.0f)), InputError);
}

}  // namespace
}  // namespace photile::test
