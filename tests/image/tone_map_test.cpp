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

}  // namespace

TEST_CASE("automatic exposure brings an even picture to mid grey, whatever its unit") {
  for (const float level : {1e-6f, 0.5f, 3.0e4f}) {
    CHECK(at(tone_map(filled(50, glm::vec3(level)), {}), 7).g == Approx(0.18).epsilon(1e-6));
  }
}

TEST_CASE("automatic exposure is the geometric mean of the luminances") {
  Image image = filled(100, glm::vec3(1.0f));
  for (std::size_t i = 0; i < 50; ++i) set(image, i, glm::vec3(4.0f));
  // sqrt(1 x 4) = 2 becomes 0.18, so 1 becomes 0.09.
  CHECK(at(tone_map(image, {}), 99).r == Approx(0.09).epsilon(1e-6));
}

TEST_CASE("pixels that see a lamp, a black background or nothing finite do not set the exposure") {
  Image image = filled(100, glm::vec3(2.0f));
  for (std::size_t i = 0; i < 10; ++i) set(image, i, glm::vec3(1.0e5f));
  for (std::size_t i = 10; i < 20; ++i) set(image, i, glm::vec3(1.0e-4f));
  for (std::size_t i = 20; i < 60; ++i) set(image, i, glm::vec3(0.0f));
  set(image, 60, glm::vec3(std::numeric_limits<float>::infinity()));
  set(image, 61, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  CHECK(at(tone_map(image, {}), 99).r == Approx(0.18).epsilon(1e-6));
}

TEST_CASE("a stop of exposure doubles, and without automatic exposure values stay") {
  const Image image = filled(4, {0.1f, 0.2f, 0.05f});
  ToneMapping manual;
  manual.automatic_exposure = false;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.1f, 0.2f, 0.05f));
  manual.exposure = 1.0;
  CHECK(at(tone_map(image, manual), 0) == glm::vec3(0.2f, 0.4f, 0.1f));
  ToneMapping automatic;
  automatic.exposure = -2.0;
  CHECK(at(tone_map(filled(4, glm::vec3(9.0f)), automatic), 0).r == Approx(0.045).epsilon(1e-6));
}

TEST_CASE("a pixel brighter than white keeps its hue") {
  ToneMapping manual;
  manual.automatic_exposure = false;
  const glm::vec3 shown = at(tone_map(filled(1, {8.0f, 4.0f, 2.0f}), manual), 0);
  CHECK(shown == glm::vec3(1.0f, 0.5f, 0.25f));
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
      const Image shown = tone_map(image, {automatic, exposure});
      bool in_range = true;
      for (const std::vector<float>& plane : shown.channels) {
        for (const float value : plane) in_range = in_range && value >= 0.0f && value <= 1.0f;
      }
      CHECK(in_range);
    }
  }
}

TEST_CASE("a black picture stays black, and one without R, G, B is an input error") {
  CHECK(at(tone_map(filled(3, glm::vec3(0.0f)), {}), 1) == glm::vec3(0.0f));
  CHECK_THROWS_AS(tone_map(Image{}, {}), InputError);
  CHECK_THROWS_AS(tone_map(filled(3, glm::vec3(0.0f)), {true, NAN}), UsageError);
}

}  // namespace photile::test
