// The layer of a group of lights beside the layers of its lights alone.
#include <catch2/catch.hpp>

#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr int neighbours = 30, samples = 2;

/// A room with a lamp that is seen and eleven standing ones, of different powers and colours.
Scene room_of_lamps() {
  Scene scene = test::furnished_room(4);
  while (scene.lights.size() < 12) {
    Light light = scene.lights.back();
    const auto i = static_cast<float>(scene.lights.size());
    light.name = "lamp" + std::to_string(scene.lights.size());
    light.position.x = 0.3f * i;
    light.power = 1.0 + i * i;
    light.color = glm::vec3(1.0f, 0.6f + 0.05f * i, 0.3f);
    light.color /= static_cast<float>(luminance(glm::dvec3(light.color)));
    scene.lights.push_back(light);
  }
  return scene;
}

RenderResult rendered(const Scene& scene, bool glossy) {
  RenderParameters parameters = small_picture(20'000, 24, 18, samples);
  parameters.neighbours = neighbours;
  parameters.radius = glossy ? 0.4 : 0;  // one that is chosen is the same in both, too
  const Camera camera = Camera::look_at({3.6, 0.4, 1.2}, {1, 2, 1.9}, {0, 0, 1}, 1.3);
  return render(scene, camera, test::device(), parameters);
}

}  // namespace

TEST_CASE("the layer of a group is the sum of its lights at their powers") {
  const bool glossy = GENERATE(false, true);
  CAPTURE(glossy);
  Scene scene = room_of_lamps();
  if (glossy) scene.materials[0] = test::glossy({0.5f, 0.4f, 0.3f}, glm::vec3(0.1f), 0.4f);
  const RenderResult alone = rendered(scene, glossy);
  const LightMix mix = LightMix::of(scene, 683);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (i != 5) scene.lights[i].group = i % 3 == 0 ? "first" : "second";
  }
  const RenderResult together = rendered(scene, glossy);
  const LightMix grouped = LightMix::of(scene, 683);
  REQUIRE(alone.layers.sparse());
  REQUIRE_FALSE(together.layers.sparse());
  REQUIRE(together.layers.layers.size() == 3);
  CHECK(together.stored_photons == alone.stored_photons);
  CHECK(together.used.radius == alone.used.radius);

  // Both sum the same terms, none negative: up to k photons of each sample and, of lights alone,
  // the lights. A sum of n terms is right to n units of 2^-24, and each term is a product of at
  // most twelve factors.
  const double tolerance = (2 * (neighbours + samples + 12) + 12) * std::ldexp(1.0, -24);
  const LightLayers dense = alone.layers.dense();
  const LightGroups groups = light_groups_of(scene);
  double worst = 0, brightest = 0;
  const auto compare = [&](double value, double expected) {
    worst = std::max(worst, std::abs(value - expected) / std::max({value, expected, 1e-30}));
    brightest = std::max(brightest, expected);
  };
  for (std::size_t g = 0; g < 3; ++g) {
    const LightLayers::Layer& layer = together.layers.layers[g];
    CHECK(layer.light == groups.groups[g].name);
    for (std::size_t pixel = 0; pixel < layer.radiance.size(); ++pixel) {
      glm::dvec3 radiance(0.0);
      double illuminance = 0;
      for (const std::uint32_t light : groups.groups[g].lights) {
        radiance += mix.lights[light].power * glm::dvec3(dense.layers[light].radiance[pixel]);
        illuminance += mix.lights[light].power * dense.layers[light].illuminance[pixel];
      }
      for (int c = 0; c < 3; ++c) {
        compare(grouped.lights[g].power * layer.radiance[pixel][c], radiance[c]);
      }
      compare(grouped.lights[g].power * layer.illuminance[pixel], illuminance);
    }
  }
  CHECK(brightest > 0);
  CHECK(worst <= tolerance);
}

}  // namespace photile::test
