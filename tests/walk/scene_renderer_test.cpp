// Many pictures from one set of maps are those of one rendering each.
#include <catch2/catch.hpp>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

RenderParameters small() { return small_picture(20'000, 24, 16); }

}  // namespace

TEST_CASE("each picture is the one that render gives, bit for bit") {
  const Scene scene = test::furnished_room();
  const RenderParameters parameters = small();
  std::span<Device> devices(&test::device(), 1);
  SceneRenderer renderer(scene, devices, parameters);
  for (const double x : {0.5, 2.0, 0.5}) {
    const Camera camera = Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
    const RenderResult kept = renderer.render(camera, parameters.film);
    const RenderResult once = render(scene, camera, devices, parameters);
    REQUIRE(kept.layers.layers.size() == 2);
    for (std::size_t light = 0; light < 2; ++light) {
      CHECK(kept.layers.layers[light].radiance == once.layers.layers[light].radiance);
      CHECK(kept.layers.layers[light].illuminance == once.layers.layers[light].illuminance);
    }
    CHECK(kept.used.radius == once.used.radius);
    CHECK(kept.stored_photons == once.stored_photons);
  }
}

TEST_CASE("pictures of several kept passes are those of render, bit for bit") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters = small();
  parameters.passes = 3;
  std::span<Device> devices(&test::device(), 1);
  SceneRenderer renderer(scene, devices, parameters);
  for (const double x : {0.5, 2.0, 0.5}) {
    const Camera camera = Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0);
    const RenderResult kept = renderer.render(camera, parameters.film);
    const RenderResult once = render(scene, camera, devices, parameters);
    CHECK(test::same_bits(kept.layers, once.layers));
    CHECK(kept.stored_photons == once.stored_photons);
  }
}

TEST_CASE("light maps of several passes are refused") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters = small();
  parameters.passes = 3;
  parameters.light_maps = LightMapMode::on;
  std::span<Device> devices(&test::device(), 1);
  CHECK_THROWS_WITH(SceneRenderer(scene, devices, parameters),
                    Catch::Contains("one photon pass") && Catch::Contains("there are 3"));
}

}  // namespace photile::test
