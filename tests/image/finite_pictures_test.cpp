// Numbers beyond those of floats, and what is no number, never reach a file, and are told.
#include <algorithm>
#include <cmath>
#include <limits>

#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

constexpr float largest = std::numeric_limits<float>::max();
constexpr float infinite = std::numeric_limits<float>::infinity();

bool is_finite(const Image& image) {
  return std::all_of(image.channels.begin(), image.channels.end(), [](const auto& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); });
  });
}

/// A picture of 70 rows, so that it is read in several turns, with layers of one value each.
Image layered(const std::vector<std::pair<std::string, float>>& layers) {
  Image image;
  image.width = 3;
  image.height = 70;
  for (const auto& [light, value] : layers) {
    for (const char* component : {".R", ".G", ".B"}) {
      image.add("Combined_" + light + component).assign(image.pixels(), value);
    }
  }
  return image;
}

/// Relit as a file. The pixels are those of what was written.
struct Relit {
  Image image;
  std::vector<std::string> overflows;

  Relit(const Image& source, const std::vector<LightChange>& changes) {
    const TemporaryFolder folder;
    write_exr(folder / "in.exr", source);
    const auto picture = relit_picture(folder / "in.exr", changes);
    write_exr(folder / "out.exr", *picture);
    write_exr(folder / "again.exr", *picture);  // counts nothing twice
    overflows = picture->overflows();
    image = read_image(folder / "out.exr");
    CHECK(is_finite(image));
  }
};

}  // namespace

TEST_CASE("layers near the largest float, turned up, are written as that and told") {
  const Relit relit(layered({{"lamp", 3e38f}, {"window", 2}}), {{"lamp", "x2"}});
  CHECK(relit.image.find("Combined_lamp.R")->front() == largest);
  CHECK(relit.image.find("Combined_window.G")->back() == 2);
  CHECK(relit.image.find("R")->back() == largest);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("light 'lamp'") && Contains("210 of 210 pixels") &&
                                     Contains("3.4e+38") && Contains("turn it down"));
}

TEST_CASE("pixels of a layer that are no numbers are black, and the rest of the picture is kept") {
  Image source = layered({{"lamp", 1}, {"window", 2}});
  source.channels[1][5] = std::nanf("");
  source.channels[0][200] = -infinite;
  const Relit relit(source, {});
  CHECK((*relit.image.find("Combined_lamp.G"))[5] == 0);
  CHECK((*relit.image.find("Combined_lamp.R"))[200] == -largest);
  CHECK((*relit.image.find("G"))[5] == 2);
  CHECK((*relit.image.find("R"))[5] == 3);
  CHECK((*relit.image.find("R"))[4] == 3);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("light 'lamp'") && Contains("2 of 210 pixels"));
}

TEST_CASE("layers that only their sum carries beyond the largest float are told as a sum") {
  const Relit relit(layered({{"lamp", 3e38f}, {"window", 2e38f}}), {});
  CHECK(relit.image.find("R")->front() == largest);
  CHECK(relit.image.find("Combined_window.R")->front() == 2e38f);
  REQUIRE(relit.overflows.size() == 1);
  CHECK_THAT(relit.overflows[0], Contains("sum of the lights") && Contains("210 of 210"));
}

TEST_CASE("an alpha that is no number is none") {
  Image source = layered({{"lamp", 1}});
  source.add("A").assign(source.pixels(), std::nanf(""));
  const Relit relit(source, {});
  CHECK(relit.image.find("A")->front() == 0);
}

TEST_CASE("a rendered light of the greatest power stays finite in every channel, and is told") {
  LightMix mix;
  mix.lights = {mixed("sun", limits::max_light_power), mixed("lamp", 1)};
  LightLayers layers = random_layers(9, 70, {"sun", "lamp"});
  for (float& value : layers.layers[0].illuminance) value = 1e12f;  // of a lamp of a micrometre
  const auto picture = mixed_picture(layers, mix);
  const Image image = to_image(*picture);
  CHECK(is_finite(image));
  CHECK(image.find("Illuminance_sun.Y")->front() == largest);
  REQUIRE(picture->overflows().size() == 1);
  CHECK_THAT(picture->overflows()[0], Contains("light 'sun'") && Contains("630 of 630"));
}

TEST_CASE("of a sound picture nothing is told") {
  LightMix mix;
  mix.lights = {mixed("a", 3), mixed("b", 5)};
  const LightLayers layers = random_layers(9, 70, {"a", "b"});
  const auto picture = mixed_picture(layers, mix);
  CHECK(is_finite(to_image(*picture)));
  CHECK(picture->overflows().empty());
}

}  // namespace photile::test
