#include <cmath>
#include <limits>

#include "picture_support.hpp"

namespace photile::test {
namespace {

Image filled(std::size_t pixels, const glm::vec3& rgb) {
  Image image;
  image.width = static_cast<int>(pixels);
  image.height = 1;
  image.add("R").assign(pixels, rgb.r);
  image.add("G").assign(pixels, rgb.g);
  image.add("B").assign(pixels, rgb.b);
  return image;
}

void set(Image& image, std::size_t pixel, const glm::vec3& rgb) {
  for (std::size_t c = 0; c < 3; ++c) image.channels[c][pixel] = rgb[static_cast<int>(c)];
}

glm::vec3 at(const Image& image, std::size_t pixel) {
  return {image.channels[0][pixel], image.channels[1][pixel], image.channels[2][pixel]};
}

/// The sRGB curve alone: what is below white stays.
const ToneMapping standard{.view = DisplayView::standard};

glm::dvec3 neutral(const glm::vec3& rgb) {
  return glm::dvec3(at(tone_map(filled(1, rgb), {.automatic_exposure = false}), 0));
}

/// Where the middle channel stands between the least and the largest: with their order, the hue.
double hue_within_sextant(const glm::dvec3& rgb) {
  const double least = std::min({rgb.r, rgb.g, rgb.b}), most = std::max({rgb.r, rgb.g, rgb.b});
  return (rgb.r + rgb.g + rgb.b - 2 * least - most) / (most - least);
}

}  // namespace

TEST_CASE("automatic exposure brings an even picture to mid grey, whatever its unit") {
  for (const float level : {1e-6f, 0.5f, 3.0e4f}) {
    CHECK(at(tone_map(filled(50, glm::vec3(level)), standard), 7).g == Approx(0.18).epsilon(1e-6));
  }
}

TEST_CASE("automatic exposure is the geometric mean of the luminances") {
  Image image = filled(100, glm::vec3(1.0f));
  for (std::size_t i = 0; i < 50; ++i) set(image, i, glm::vec3(4.0f));
  // sqrt(1 x 4) = 2 becomes 0.18, so 1 becomes 0.09.
  CHECK(at(tone_map(image, standard), 99).r == Approx(0.09).epsilon(1e-6));
}

TEST_CASE("pixels that see a lamp, a black background or nothing finite do not set the exposure") {
  Image image = filled(100, glm::vec3(2.0f));
  for (std::size_t i = 0; i < 10; ++i) set(image, i, glm::vec3(1.0e5f));
  for (std::size_t i = 10; i < 20; ++i) set(image, i, glm::vec3(1.0e-4f));
  for (std::size_t i = 20; i < 60; ++i) set(image, i, glm::vec3(0.0f));
  set(image, 60, glm::vec3(std::numeric_limits<float>::infinity()));
  set(image, 61, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  CHECK(at(tone_map(image, standard), 99).r == Approx(0.18).epsilon(1e-6));
}

TEST_CASE("a stop of exposure doubles, and without automatic exposure values stay") {
  const Image image = filled(4, {0.1f, 0.2f, 0.05f});
  ToneMapping manual = standard;
  manual.automatic_exposure = false;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.1f, 0.2f, 0.05f));
  manual.exposure = 1.0;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.2f, 0.4f, 0.1f));
  ToneMapping automatic = standard;
  automatic.exposure = -2.0;
  CHECK(at(tone_map(filled(4, glm::vec3(9.0f)), automatic), 0).r == Approx(0.045).epsilon(1e-6));
}

TEST_CASE("through the sRGB curve alone a pixel brighter than white is scaled as a whole") {
  ToneMapping manual = standard;
  manual.automatic_exposure = false;
  const glm::vec3 shown = at(tone_map(filled(1, {8.0f, 4.0f, 2.0f}), manual), 0);
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

TEST_CASE("tone mapping gives values in [0,1] for every float") {
  using Limits = std::numeric_limits<float>;
  const float awkward[] = {0.0f,
                           -0.0f,
                           1.0f,
                           -5.0f,
                           Limits::max(),
                           Limits::lowest(),
                           Limits::denorm_min(),
                           Limits::infinity(),
                           -Limits::infinity(),
                           Limits::quiet_NaN()};
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

}  // namespace photile::test
