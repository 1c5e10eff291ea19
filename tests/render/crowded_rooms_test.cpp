// The mean of a room full of small things, between which photon estimates blur.
#include <array>
#include <catch2/catch.hpp>

#include "light/light_at_points.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

/// Mean luminance of all lights at their powers.
double mean_of(const LightLayers& picture, const Scene& scene) {
  const std::vector<double> powers = light::layer_powers(scene);
  const LightLayers dense = picture.dense();
  double sum = 0;
  for (std::size_t layer = 0; layer < powers.size(); ++layer) {
    for (const glm::vec3& pixel : dense.layers[layer].radiance) {
      sum += powers[layer] * luminance(glm::dvec3(pixel));
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("crowded rooms: by default the living room is as bright as paths find it", "[slow]") {
  const Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
  const Camera& camera = scene.cameras.front();
  RenderParameters parameters;
  set_quality(parameters, Quality::good);
  parameters.film.width = 96;
  parameters.film.height = 64;
  PrimaryHitParameters paths = eye_rays(parameters);
  paths.samples_per_pixel = 2048;
  const double truth = mean_of(trace_paths(scene, camera, paths).layers, scene);
  double mean = 0;
  constexpr std::array<std::uint64_t, 3> seeds{1, 2, 3};
  for (const std::uint64_t seed : seeds) {
    parameters.seed = seed;
    mean += mean_of(render(scene, camera, device(), parameters).layers, scene) / seeds.size();
  }
  CAPTURE(mean / truth);
  CHECK(mean == Approx(truth).epsilon(0.005));
}

}  // namespace photile::test
