// `--illuminance` and `--luminance` of `photile render` and `photile relight`.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "report/palette.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using Colour = std::array<std::uint8_t, 3>;

Colour colour_at(const Image& png, int x, int y) {
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float code = png.channels[c][static_cast<std::size_t>(y * png.width + x)];
    colour[c] = static_cast<std::uint8_t>(std::lround(255 * static_cast<double>(code)));
  }
  return colour;
}

/// An EXR of 3 x 1 pixels with 100, 200 and 400 lux by a lamp of 10 lm, and 25, 50 and 100 cd/m2.
std::string write_picture(const FileFolder& folder) {
  LightLayers layers(3, 1, std::vector<std::string>{"lamp"});
  layers.layers[0].illuminance = {10, 20, 40};
  layers.layers[0].radiance = {glm::vec3(2.5f), glm::vec3(5), glm::vec3(10)};
  LightMix mix;
  mix.lights.resize(1);
  mix.lights[0].name = "lamp";
  mix.lights[0].power = 10;
  write_exr(folder / "lamp.exr", *mixed_picture(layers, mix));
  return folder / "lamp.exr";
}

void run(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_photile(arguments);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.errors, !Contains("warning"));
}

}  // namespace

TEST_CASE("relight draws known lux and cd/m2 in their colours, as its changes leave them") {
  const FileFolder folder;
  const std::string picture = write_picture(folder);
  const report::Palette palette("turbo");
  const double factor = GENERATE(1.0, 2.0);
  run({"relight", picture, "--light", factor == 1 ? "lamp=10" : "lamp=20", "--illuminance",
       folder / "lux.png", "--luminance", folder / "luminance.png", "-s", "1000"});
  const Image lux = read_image(folder / "lux.png");
  const Image luminance = read_image(folder / "luminance.png");
  const std::array values{100.0, 200.0, 400.0};
  for (int x = 0; x < 3; ++x) {
    INFO("pixel " << x << ", lamp x" << factor);
    const double expected = factor * values[static_cast<std::size_t>(x)];
    CHECK(colour_at(lux, x, 0) == palette.at(expected / 1000));
    CHECK(colour_at(luminance, x, 0) == palette.at(expected / 4 / 1000));
  }
}

TEST_CASE("relight takes the options of falsecolor") {
  const FileFolder folder;
  const std::string picture = write_picture(folder);
  run({"relight", picture, "--illuminance", folder / "auto.png", "-s", "auto", "--pal", "viridis"});
  CHECK(colour_at(read_image(folder / "auto.png"), 1, 0) == report::Palette("viridis").at(0.5));
  run({"relight", picture, "--illuminance", folder / "log.png", "-s", "400", "--log", "1"});
  CHECK(colour_at(read_image(folder / "log.png"), 1, 0) ==
        report::Palette("turbo").at(1 + std::log10(0.5)));
  run({"relight", picture, "--illuminance", folder / "steps.png", "--cp", "-n", "4"});
  CHECK(colour_at(read_image(folder / "steps.png"), 2, 0) == report::Palette("turbo").at(0.375));
}

TEST_CASE("under an even sky of 500 lux a floor has the colour of 500 lux") {
  const FileFolder folder;
  folder.write("floor.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  const std::string scene = folder.write("floor.obj",
                                         "mtllib floor.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\n"
                                         "v -1 0 1\no floor\nusemtl grey\nf 4 3 2 1\n");
  // Posterized in steps of 200 lux: a pixel would have to be off by 100 lux to have another colour.
  run({"render", scene, "--sky", "uniform=500", "--size", "64x48", "--photons", "300k", "-k", "600",
       "--quality", "draft", "-o", folder / "floor.exr"});
  run({"relight", folder / "floor.exr", "--illuminance", folder / "lux.png", "--cp", "-n", "5"});
  const Image lux = read_image(folder / "lux.png");
  const report::Palette palette("turbo");
  std::map<Colour, int> pixels;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) ++pixels[colour_at(lux, x, y)];
  }
  const int dark = pixels[palette.at(0.1)];  // where the sky is seen, which is no surface
  const int lit = 64 * 48 - dark;
  CHECK(lit > 200);
  CHECK(pixels[palette.at(0.5)] > 0.8 * lit);  // the rest is the floor's border
}

TEST_CASE("what is drawn of a render is what its EXR holds, in scenes of watts as well") {
  const FileFolder folder;
  run({"render", write_box(folder), "--size", "24x16", "--photons", "20k", "--quality", "draft",
       "-o", folder / "a.exr", "--illuminance", folder / "lux.png", "--luminance",
       folder / "luminance.png", "-s", "3000"});
  const Image exr = read_image(folder / "a.exr");
  const Image lux = read_image(folder / "lux.png"), drawn = read_image(folder / "luminance.png");
  const report::Palette palette("turbo");
  const double efficacy = 683;
  for (std::size_t pixel = 0; pixel < exr.pixels(); ++pixel) {
    const auto value = [&](const char* channel) {
      return static_cast<double>((*exr.find(channel))[pixel]);
    };
    const int x = static_cast<int>(pixel) % 24, y = static_cast<int>(pixel) / 24;
    const double sum = value("Illuminance_left.Y") + value("Illuminance_right.Y");
    CHECK(colour_at(lux, x, y) == palette.at(sum / 3000));
    const double radiance = 0.2126 * value("R") + 0.7152 * value("G") + 0.0722 * value("B");
    CHECK(colour_at(drawn, x, y) == palette.at(efficacy * radiance / 3000));
  }
}

TEST_CASE("a drawing in false colour needs its values and a PNG") {
  const FileFolder folder;
  const std::string picture = write_picture(folder);
  const auto error = [&](std::vector<std::string> arguments, int code) {
    return only_error(run_photile(arguments), code);
  };
  CHECK_THAT(error({"relight", picture, "--illuminance", folder / "lux.exr"}, 2),
             Contains("lux.exr") && Contains(".png"));
  CHECK_THAT(error({"render", write_box(folder), "-q", "--luminance", folder / "a.jpg"}, 2),
             Contains("a.jpg") && Contains(".png"));
  CHECK_THAT(error({"relight", picture, "--illuminance", folder / "a.png", "--cl", "--cb"}, 2),
             Contains("--c"));
  CHECK_THAT(error({"relight", picture, "--illuminance", folder / "a.png", "-s", "-3"}, 2),
             Contains("-3"));
  // Light groups as other programs write them.
  Image foreign;
  foreign.width = foreign.height = 1;
  for (const char* channel : {"Combined_key.R", "Combined_key.G", "Combined_key.B"}) {
    foreign.add(channel) = {1};
  }
  write_exr(folder / "foreign.exr", foreign);
  CHECK_THAT(error({"relight", folder / "foreign.exr", "-o", folder / "a.exr", "--illuminance",
                    folder / "a.png"},
                   3),
             Contains("Combined_key"));
  CHECK_THAT(error({"relight", folder / "foreign.exr", "--luminance", folder / "a.png"}, 3),
             Contains("whiteLuminance"));
  CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

}  // namespace photile::test
