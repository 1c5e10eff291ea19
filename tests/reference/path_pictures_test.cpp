// Pictures of the path tracer: what they do not depend on, and their layers.

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "../render/pictures.hpp"
#include "photile/renderer.hpp"
#include "render/hit_source.hpp"
#include "statistical_tests.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

PrimaryHitParameters film(int width, int height, int samples, std::uint64_t seed = 1) {
  PrimaryHitParameters result;
  result.width = width;
  result.height = height;
  result.samples_per_pixel = samples;
  result.seed = seed;
  return result;
}

}  // namespace

TEST_CASE("another seed gives another path-traced picture") {
  const Scene scene = test::furnished_room();
  const auto of = [&](std::uint64_t seed) {
    return trace_paths(scene, test::room_camera(), film(8, 6, 1, seed)).layers;
  };
  CHECK_FALSE(test::same_bits(of(1), of(2)));
}

TEST_CASE("lights beyond the dense ones give the same path-traced layers, in the sparse form") {
  Scene scene = test::furnished_room();
  for (int i = 0; i < 7; ++i) {
    scene.lights.push_back(test::point_light("spare " + std::to_string(i),
                                             {0.3f + 0.4f * static_cast<float>(i), 1, 2}, 100));
  }
  const LightLayers sparse = trace_paths(scene, test::room_camera(), film(16, 12, 4)).layers;
  REQUIRE(sparse.sparse());
  // In one group the same paths give the same light together: sum of shares x layers.
  Scene grouped = scene;
  for (Light& light : grouped.lights) light.group = "all";
  const LightLayers together = trace_paths(grouped, test::room_camera(), film(16, 12, 4)).layers;
  REQUIRE(together.layers.size() == 1);
  double power = 0, sum = 0;
  const LightLayers dense = sparse.dense();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    power += scene.lights[i].power;
    sum += scene.lights[i].power * test::LayerMeans(dense.layers[i]).radiance;
    CHECK(test::LayerMeans(dense.layers[i]).radiance > 0);
  }
  CHECK(power * test::LayerMeans(together.layers[0]).radiance == Approx(sum).epsilon(1e-4));
}

TEST_CASE("a path-traced floor under a point light: mean illuminance and radiance over a square") {
  // The closed form of tests/render: the solid angle of the square, 4 asin(1 / 2), times 1 cd, over
  // 4 m2.
  constexpr float albedo = 0.6f;
  Scene scene = test::plate(test::diffuse(glm::vec3(albedo)), 4.0f, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}, 4.0 * glm::pi<double>()));
  const Camera camera =
      Camera::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(1.0 / 3.0));
  const double truth = std::asin(0.5);
  std::vector<double> illuminance, radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto layer = trace_paths(scene, camera, film(48, 48, 4, seed)).layers.layers[0];
    illuminance.push_back(scene.lights[0].power * test::LayerMeans(layer).illuminance);
    radiance.push_back(scene.lights[0].power * test::LayerMeans(layer).radiance);
  }
  CHECK_VERDICT(test::mean_is(illuminance, truth, 0.001 * truth));
  const double reflected = truth * double{albedo} / glm::pi<double>();
  CHECK_VERDICT(test::mean_is(radiance, reflected, 0.001 * reflected));
}

TEST_CASE("reflections by paths are what the lobe reflects of a lamp, whatever lies below it") {
  // No light comes back to the plate: with a black base the lobe is all that is seen of it.
  const auto plate = [](float albedo) {
    Scene scene = test::plate(test::glossy(glm::vec3(albedo), glm::vec3(0.3f), 0.4f), 4.0f, 3);
    scene.lights.push_back(test::point_light("lamp", {0.5f, 0, 1}, 10));
    return scene;
  };
  const Camera camera = Camera::look_at({-1, 0, 2}, {0, 0, 0}, {0, 0, 1}, 0.5);
  const LightLayers black = trace_paths(plate(0.0f), camera, film(16, 12, 4)).layers;
  const LightLayers white = trace_paths(plate(0.9f), camera, film(16, 12, 4)).layers;
  const LightLayers lobe =
      trace_paths_of_hits(plate(0.9f), reflected_hits(camera), film(16, 12, 4), Progress::none())
          .layers;
  for (std::size_t pixel = 0; pixel < lobe.layers[0].radiance.size(); ++pixel) {
    CHECK(luminance(lobe.layers[0].radiance[pixel]) ==
          Approx(luminance(black.layers[0].radiance[pixel])).epsilon(1e-5));
  }
  CHECK(test::LayerMeans(lobe.layers[0]).radiance > 0);
  CHECK(test::LayerMeans(lobe.layers[0]).radiance <
        0.5 * test::LayerMeans(white.layers[0]).radiance);
}

}  // namespace photile::test
