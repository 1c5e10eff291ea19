// What changes no picture: lamps of more power, and instances in place of copies. Threads, devices,
// processes, windings and kept photons are in tests/equal_bits.
#include <catch2/catch.hpp>

#include "instanced_scenes.hpp"
#include "neighbour_comparison.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using test::room_camera;
using test::same_bits;

RenderParameters small_parameters() { return small_picture(30'000, 64, 48); }

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

TEST_CASE("lamps of twice the power render the same bits per unit of power") {
  Scene scene = test::furnished_room(2);
  RenderParameters parameters = small_parameters();
  if (GENERATE(false, true)) {  // nodes are refined where light at the lamps' powers varies
    parameters.light_maps = LightMapMode::on;
    parameters.light_map_rays = 8;
  }
  const auto once = render(scene, room_camera(), test::device(), parameters).layers;
  for (Light& light : scene.lights) light.power *= 2;
  CHECK(same_bits(once, render(scene, room_camera(), test::device(), parameters).layers));
}

TEST_CASE("another seed renders another picture") {
  const Scene scene = test::furnished_room(2);
  RenderParameters parameters = small_parameters();
  const auto first = render(scene, room_camera(), test::device(), parameters).layers;
  parameters.seed = 2;
  CHECK_FALSE(same_bits(first, render(scene, room_camera(), test::device(), parameters).layers));
}

TEST_CASE("a cancelled rendering stops with Interrupted") {
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  const Scene scene = test::furnished_room(2);
  CHECK_THROWS_AS(render(scene, room_camera(), test::device(), small_parameters(), progress),
                  Interrupted);
}

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
