// From layers and powers to what the screen shows.
#include "image/display.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "image/glare.hpp"
#include "photile/errors.hpp"
#include "report/palette.hpp"
#include "report/tables.hpp"
#include "test_scenes.hpp"
#include "two_lights.hpp"
#include "view/frame.hpp"

namespace photile::test {

using namespace photile::view;

namespace {

/// Two lights over two pixels, at power 1.
Frame two_pixels() {
  Frame frame;
  frame.layers = LightLayers(2, 1, {"a", "b"});
  frame.layers.layers[0].radiance = {glm::vec3(1), glm::vec3(0)};
  frame.layers.layers[0].illuminance = {3, 0};
  frame.layers.layers[1].radiance = {glm::vec3(0.5f), glm::vec3(0.25f)};
  frame.layers.layers[1].illuminance = {1, 2};
  return frame;
}

LightMix mix_of(double a, double b) { return test::two_lights("a", a, "b", b); }

}  // namespace

TEST_CASE("illuminance is the sum over lights of power times layer") {
  CHECK(mixed_illuminance(two_pixels().layers, mix_of(10, 100)) == std::vector<float>{130, 200});
}

TEST_CASE("a frame is shown as a picture of the same light is written") {
  Frame frame;
  frame.layers.width = 64, frame.layers.height = 3;
  Image picture;
  picture.width = 64, picture.height = 3;
  for (const char* channel : {"R", "G", "B"}) picture.add(channel);
  for (int i = 0; i < 64 * 3; ++i) {
    glm::vec3 light(std::exp2(0.1f * static_cast<float>(i) - 12), 0.01f * static_cast<float>(i),
                    0.3f);
    if (i == 7) light = glm::vec3(-1, std::nanf(""), HUGE_VALF);
    frame.mixed.push_back(light);
    for (int channel = 0; channel < 3; ++channel) {
      picture.channels[static_cast<std::size_t>(channel)][static_cast<std::size_t>(i)] =
          light[channel];
    }
  }
  for (const DisplayView view : {DisplayView::neutral, DisplayView::standard}) {
    DisplaySettings settings;
    settings.exposure = 1.3;
    settings.view = view;
    CHECK(display(frame, mix_of(1, 1), settings).rgb ==
          image::srgb8_texels(tone_map(picture, {false, 1.3, view})));
  }
}

TEST_CASE("a quick frame has the white of its lamps' powers, another that of their illuminance") {
  LightMix mix = mix_of(10, 30);
  mix.lights[0].color = {2.0f, 0.8f, 0.03f};
  const auto check = [&](const Frame& frame, double first, double second) {
    const glm::dvec3 sum = first * glm::dvec3(mix.lights[0].color * mix.lights[0].tint) +
                           second * glm::dvec3(mix.lights[1].color * mix.lights[1].tint);
    const auto white = white_of(frame, mix);
    for (int channel = 0; channel < 3; ++channel) {
      CHECK(double{white[static_cast<std::size_t>(channel)]} ==
            Approx(sum[channel] / luminance(sum)));
    }
  };
  Frame quick;
  quick.mixed.emplace_back(1.0f);
  check(quick, 10, 30);
  const Frame frame = two_pixels();
  double lux[2]{};
  for (int light = 0; light < 2; ++light) {
    for (int pixel = 0; pixel < 2; ++pixel) {
      lux[light] +=
          readings_at(frame, mix, pixel, 0)[static_cast<std::size_t>(light)].illuminance.value;
    }
  }
  check(frame, lux[0], lux[1]);
}

TEST_CASE("a reading has each light's part of luminance and illuminance") {
  const auto readings = readings_at(two_pixels(), mix_of(10, 100), 0, 0);
  CHECK(readings[0].illuminance.value == Approx(30));
  CHECK(readings[1].illuminance.value == Approx(100));
  CHECK(readings[0].luminance.value == Approx(10));
  CHECK(readings[1].luminance.value == Approx(50));
  CHECK(readings_at(two_pixels(), mix_of(10, 100), 2, 0)[1].illuminance.value == 0);
}

TEST_CASE("a reading's standard error is that of the photons it was counted from") {
  Frame frame = two_pixels();
  frame.noise = {100, {1, 9}};  // photons as 3 x 1 to 1 x 9: 25 and 75 of them
  const auto readings = readings_at(frame, mix_of(10, 100), 0, 0);
  CHECK(readings[0].illuminance.standard_error == Approx(30 / std::sqrt(25.0)));
  CHECK(readings[1].illuminance.standard_error == Approx(100 / std::sqrt(75.0)));
  CHECK(readings[0].luminance.standard_error == Approx(10 / std::sqrt(25.0)));
  const LightReading sum = sum_of(readings);
  CHECK(sum.illuminance.value == Approx(130));
  CHECK(sum.illuminance.standard_error == Approx(std::sqrt(36 + 10000 / 75.0)));
  // Photons of one weight: the error is that of their number.
  const LightReading even = sum_of(readings_at(frame, mix_of(1, 9), 0, 0));
  CHECK(even.illuminance.standard_error == Approx(even.illuminance.value / std::sqrt(100.0)));
  CHECK(readings_at(frame, mix_of(10, 100), 1, 0)[0].illuminance.standard_error == 0);
}

TEST_CASE("what an estimate's noise depends on follows from k, the kernel and the paths") {
  const Scene scene = test::furnished_room(4);
  RenderParameters parameters;
  parameters.neighbours = 52;
  parameters.photons.emitted_photons = 10'000;
  EstimateNoise noise = EstimateNoise::of(scene, parameters);
  CHECK(noise.photons == 50);
  CHECK(std::accumulate(noise.paths.begin(), noise.paths.end(), 0.0) == 10'000);
  parameters.kernel = DensityKernel::cone;
  CHECK(EstimateNoise::of(scene, parameters).photons == Approx(50 / 1.5));
}

TEST_CASE("the paths of pooled lights are those of their powers together, of dark ones none") {
  EstimateNoise noise;
  noise.paths = {100, 300, 50};
  const LayerMixdown mixdown{{"on", "off"}, {0, 0, 1}, {2, 3, 0}};
  CHECK(noise.pooled(mixdown).paths == std::vector<double>{400.0 / 5, 0});
}

TEST_CASE("a number has as many digits as its error leaves meaning") {
  using report::text_with_error;
  CHECK(text_with_error(229.3, 32.4) == "230 +-30");
  CHECK(text_with_error(294.06, 0.22) == "294.1 +-0.2");
  CHECK(text_with_error(12345, 1234) == "12000 +-1000");
  CHECK(text_with_error(0.00123, 0.00034) == "0.0012 +-0.0003");
  CHECK(text_with_error(229.34, 0) == "229.3");
}

TEST_CASE("illuminance is in lux where lamps are in watts, too") {
  LightMix mix = mix_of(10, 100);
  for (MixedLight& light : mix.lights) light.unit = PowerUnit::watt;
  mix.lumen_per_watt = 179;
  CHECK(mixed_illuminance(two_pixels().layers, mix) == std::vector<float>{130 * 179, 200 * 179});
  const auto readings = readings_at(two_pixels(), mix, 0, 0);
  CHECK(readings[1].illuminance.value == Approx(100 * 179));
  CHECK(readings[1].luminance.value == Approx(50));  // W/(m2 sr)
}

TEST_CASE("the picture is scaled by stops and encoded as sRGB") {
  DisplaySettings settings;
  settings.exposure = -1;  // halves
  settings.view = DisplayView::standard;
  const DisplayedFrame shown = display(two_pixels(), mix_of(0, 1), settings);
  // 0.25 and 0.125 in sRGB: 255 (1.055 x^(1/2.4) - 0.055) = 136.9 and 99.1
  CHECK(shown.rgb == std::vector<std::uint8_t>{137, 137, 137, 99, 99, 99});
}

TEST_CASE("false colour runs over its palette from zero to the top of the scale") {
  DisplaySettings settings;
  settings.mode = DisplayMode::illuminance;
  settings.false_colour.scale = 260;
  const DisplayedFrame shown = display(two_pixels(), mix_of(10, 100), settings);
  const auto middle = report::Palette("turbo").at(0.5);  // 130 of 260
  CHECK(std::equal(middle.begin(), middle.end(), shown.rgb.begin()));
  settings.false_colour.palette = "no such";
  CHECK_THROWS_AS(display(two_pixels(), mix_of(1, 1), settings), UsageError);
}

TEST_CASE("contours are drawn over the picture, posterized values fill it") {
  DisplaySettings settings;
  settings.mode = DisplayMode::illuminance;
  settings.false_colour.scale = 400;
  settings.false_colour.steps = 2;      // levels 100 and 300; bands 80 to 120 and 280 to 320
  const LightMix mix = mix_of(10, 39);  // 69 and 78 lux at the pixels, hence no band
  settings.false_colour.contours = report::Contours::bands;
  DisplaySettings picture;
  CHECK(display(two_pixels(), mix, settings).rgb == display(two_pixels(), mix, picture).rgb);
  const LightMix brighter = mix_of(10, 50);  // 80 and 100: the second is in a band
  const auto band = display(two_pixels(), brighter, settings);
  const auto colour = report::Palette("turbo").at(0.25);
  CHECK(std::equal(colour.begin(), colour.end(), band.rgb.begin() + 3));
  settings.false_colour.contours = report::Contours::lines;  // between 80 and 100
  const auto line = display(two_pixels(), brighter, settings);
  const auto left = report::Palette("turbo").at(0.2);
  CHECK(std::equal(left.begin(), left.end(), line.rgb.begin()));
  settings.false_colour.contours = report::Contours::steps;
  const auto steps = display(two_pixels(), brighter, settings);
  CHECK(std::equal(colour.begin(), colour.end(), steps.rgb.begin()));
  CHECK(std::equal(colour.begin(), colour.end(), steps.rgb.begin() + 3));
}

TEST_CASE("glare marks reflections over the dimmed picture") {
  Frame frame = two_pixels();
  DisplaySettings settings;
  settings.mode = DisplayMode::glare;
  const LightMix mix = mix_of(1, 1);
  const auto picture = display(frame, mix, settings).rgb;  // without reflections: the picture
  frame.reflections = LightLayers(2, 1, {"a", "b"});
  frame.reflections->layers[1].radiance[1] = glm::vec3(200);
  settings.glare_limit = 150;
  const auto marked = display(frame, mix, settings).rgb;
  const auto colour = image::mark_colour(1);
  CHECK(marked[0] == picture[0] / 2);
  CHECK(std::equal(colour.begin(), colour.end(), marked.begin() + 3));
}

}  // namespace photile::test
