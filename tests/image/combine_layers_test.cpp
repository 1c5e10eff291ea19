#include <algorithm>
#include <array>
#include <limits>

#include "picture_support.hpp"

namespace photile::test {
namespace {

/// combine_layers beside the sum of what mix_layers gives as layers.
void check_equal_to_sum(const LightLayers& layers, const LightMix& mix) {
  const Image mixed = mix_layers(layers, mix);
  const std::size_t pixels = mixed.pixels();
  std::vector<glm::vec3> picture(pixels, glm::vec3(7.0f));
  combine_layers(layers, mix, picture);
  for (int c = 0; c < 3; ++c) {
    std::vector<float> plane;
    // What is infinite is the largest float in layers.
    for (const glm::vec3& pixel : picture) {
      plane.push_back(std::min(pixel[c], std::numeric_limits<float>::max()));
    }
    std::vector<float> sum(pixels, 0.0f);
    for (const LightLayers::Layer& layer : layers.layers) {
      const std::vector<float>& part =
          *mixed.find("Combined_" + layer.light + "." + std::string(1, "RGB"[c]));
      for (std::size_t i = 0; i < pixels; ++i) sum[i] += part[i];
    }
    CHECK(same_bits(plane, sum));
  }
}

}  // namespace

TEST_CASE("combined layers are the bits of the sum of mixed ones, at sizes around the blocks") {
  LightMix mix;
  mix.lights = {mixed("a", 812.5), mixed("b", 3.1), mixed("c", 47.0)};
  mix.lights[1].tint = {2.0f, 1.0f, 0.5f};
  for (const int width : {1, 15, 16, 17, 1023, 1024, 1025, 5000}) {
    CAPTURE(width);
    check_equal_to_sum(random_layers(width, 3, {"c", "a", "b"}), mix);
  }
}

TEST_CASE("combined sparse layers are the bits of the sum of mixed ones") {
  const LightLayers layers = random_sparse_layers(37, 9, 11);
  REQUIRE(layers.sparse());
  LightMix mix;
  for (const LightLayers::Layer& layer : layers.layers) {
    mix.lights.push_back(mixed(layer.light, 1.5 * static_cast<double>(mix.lights.size())));
    mix.lights.back().tint = {2.0f, 1.0f, 0.5f};
  }
  check_equal_to_sum(layers, mix);
  mix.lights[3].power = 0;  // off
  check_equal_to_sum(layers, mix);
}

TEST_CASE("a combined light that is off adds nothing, even where its layer is infinite") {
  LightLayers layers = random_layers(40, 2, {"a", "b"});
  layers.layers[1].radiance[20] = glm::vec3(std::numeric_limits<float>::infinity());
  LightMix mix;
  mix.lights = {mixed("a", 2.0), mixed("b", 0.0)};
  check_equal_to_sum(layers, mix);
  mix.lights[1] = mixed("b", 1.0);
  mix.lights[1].tint = {1.0f, 0.0f, 1.0f};
  check_equal_to_sum(layers, mix);
}

TEST_CASE("no layers combine to black") {
  LightLayers layers;
  layers.width = layers.height = 2;
  std::vector<glm::vec3> picture(4, glm::vec3(1.0f));
  combine_layers(layers, LightMix{}, picture);
  CHECK(picture == std::vector<glm::vec3>(4, glm::vec3(0.0f)));
}

TEST_CASE("combining refuses a picture of another size and a mix without the light") {
  const LightLayers layers = random_layers(3, 2, {"a"});
  LightMix mix;
  mix.lights = {mixed("a", 1.0)};
  std::vector<glm::vec3> picture(5);
  CHECK_THROWS_AS(combine_layers(layers, mix, picture), UsageError);
  picture.resize(6);
  mix.lights = {mixed("b", 1.0)};
  CHECK_THROWS_AS(combine_layers(layers, mix, picture), UsageError);
}

}  // namespace photile::test
