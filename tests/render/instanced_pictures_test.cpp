// A scene with instances renders as the same scene without.
#include <catch2/catch.hpp>
#include <cmath>

#include "instanced_scenes.hpp"
#include "neighbour_comparison.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

/// Sum over the pixels of each layer.
std::vector<double> sums(const LightLayers& picture) {
  std::vector<double> sums;
  for (const auto& layer : picture.layers) {
    double sum = 0;
    for (const glm::vec3& radiance : layer.radiance) sum += luminance(glm::dvec3(radiance));
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace

TEST_CASE("instances render the picture of the flattened scene") {
  const Scene scene = test::room_of_balls();
  RenderParameters parameters = small_picture(30'000, 64, 48);
  parameters.radius = 0.15;
  const LightLayers shared = render(scene, test::room_camera(), test::device(), parameters).layers;
  const LightLayers flat =
      render(test::flattened(scene), test::room_camera(), test::device(), parameters).layers;
  REQUIRE(shared.layers.size() == flat.layers.size());
  // A photon in a thousand parts from its twin; an estimate has some 50 photons, and a path that
  // passes an edge on the other side changes a few of them.
  for (std::size_t light = 0; light < shared.layers.size(); ++light) {
    CHECK(sums(shared)[light] == Approx(sums(flat)[light]).epsilon(2e-3));
    std::size_t close = 0;
    const auto& a = shared.layers[light].radiance;
    const auto& b = flat.layers[light].radiance;
    for (std::size_t i = 0; i < a.size(); ++i) {
      close += glm::distance(a[i], b[i]) <= 0.02f * glm::length(b[i]);
    }
    CHECK(static_cast<double>(close) > 0.95 * static_cast<double>(a.size()));
  }
}

TEST_CASE("neighbours in a scene with instances equal the oracle's") {
  const Scene scene = test::room_of_balls(6);
  const RayScene rays(scene);
  const Photons photons = trace_photons(rays, {.emitted_photons = 4'000}).photons;
  PrimaryHitParameters film;
  film.width = 24;
  film.height = 18;
  film.samples_per_pixel = 1;
  const PrimaryHits hits = trace_primary_hits(rays, test::room_camera(), film, 0, film.height).hits;
  const double radius = 0.3;
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  Estimator estimator(maps, scene, {20, 0});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  CHECK(test::count_differences(hits, estimator.nearest(hits), oracle, photons,
                                static_cast<float>(radius)) == 0);
}

}  // namespace photile::test
