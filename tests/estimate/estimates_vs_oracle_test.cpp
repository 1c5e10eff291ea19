// Irradiance and reflected radiance of every hit, over whole discs, against brute force in double
// precision.
#include <catch2/catch.hpp>

#include "estimates_comparison.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

void check_irradiance(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                      double radius, int k) {
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const std::size_t lights = scene.lights.size();
  const auto expected = test::expected_irradiance(oracle, hits, k, radius);
  for (const structures::Structure& structure : structures::all()) {
    const PhotonMaps maps =
        structures::build(structure, test::device(), scene, photons, groups, {radius, 4});
    const Estimates estimates =
        Estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc}).estimate(hits);
    const auto irradiance = test::by_light(estimates.irradiance, estimates, lights);
    REQUIRE(irradiance.size() == hits.size() * lights);
    CHECK(estimates.radiance.empty());
    CAPTURE(structure.name, k, radius, lights);
    CHECK(test::worst_difference(irradiance, expected) <= test::estimate_tolerance(k));
  }
}

}  // namespace

TEST_CASE("irradiance equals the oracle's for one light") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3);
  const Photons photons = test::uniform_photons(scene, 6000, 51);
  const PrimaryHits hits = test::uniform_hits(scene, 300, 52);
  for (const int k : {1, 2, 16, 50, 400}) check_irradiance(scene, photons, hits, 0.2, k);
}

TEST_CASE("irradiance equals the oracle's per light, for few and for many lights", "[long]") {
  // One more than fit registers, a hash table with places to spare and one without, two-byte
  // lights.
  for (const std::size_t lights : {2u, 8u, 9u, 40u, 200u, 300u}) {
    Scene scene = test::empty_scene(lights);
    test::add_torus(scene, 1.0f, 0.4f, 24, 12);
    const Photons photons = test::uniform_photons(scene, 20'000, 53);
    check_irradiance(scene, photons, test::uniform_hits(scene, 200, 54), 0.3, 50);
  }
}

TEST_CASE("with fewer than k photons within the radius the full disc counts") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  const Photons photons = test::uniform_photons(scene, 60, 55);
  check_irradiance(scene, photons, test::uniform_hits(scene, 100, 56), 0.1, 50);
}

TEST_CASE("photons in one point: ties share the estimate as the oracle says") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  std::mt19937_64 random(57);
  Photons photons;
  for (int i = 0; i < 2000; ++i) {
    test::add_photon(photons, scene, {0.5f, 0.25f, 0}, 0, random);
  }
  photons = sort_by_sided_triangle(std::move(photons), 4);
  PrimaryHits hits = test::uniform_hits(scene, 50, 58, false);
  hits.position[0] = {0.5f, 0.25f, 0};
  check_irradiance(scene, photons, hits, 0.5, 50);
}

TEST_CASE("glossy radiance equals the BSDF summed over the oracle's neighbours in double") {
  Scene scene = test::empty_scene(2);
  scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
  scene.materials[0].roughness = 0.3f;
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  const Photons photons = test::uniform_photons(scene, 5000, 59);
  REQUIRE(photons.incoming.size() == photons.size());
  PrimaryHits hits = test::uniform_hits(scene, 100, 60);
  test::add_lobes(hits, scene, 61);
  const double radius = 0.2;
  const int k = 50;
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  const Estimates estimates =
      Estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc}).estimate(hits);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);

  const auto expected = test::expected_radiance(oracle, photons, hits, 2, k, radius);
  CHECK(test::worst_difference(estimates.radiance, expected) <= test::glossy_tolerance(k));
}

TEST_CASE("radiance under normal maps equals the BSDF summed over the oracle's neighbours") {
  Scene scene = test::empty_scene(2);
  scene.materials[0].specular = glm::vec3(0.04f);
  scene.materials[0].roughness = 0.4f;
  scene.materials[0].normal_texture = 0;
  scene.textures.emplace_back("flat", 1, 1,
                              std::vector<std::array<std::uint8_t, 4>>{{128, 128, 255, 255}});
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  scene.corner_uv.resize(scene.triangle_count());
  REQUIRE(needs_of(scene).normal_maps);
  const Photons photons = test::uniform_photons(scene, 5000, 59);
  PrimaryHits hits = test::uniform_hits(scene, 100, 60);
  test::add_lobes(hits, scene, 61);
  std::mt19937_64 random(62);
  std::uniform_real_distribution<float> tilt(-0.4f, 0.4f);
  for (HitLobe& lobe : hits.lobe) {
    lobe.f90 = 0.8f;
    lobe.smooth_normal = lobe.normal;
    lobe.normal = glm::normalize(lobe.normal + glm::vec3(tilt(random), tilt(random), tilt(random)));
  }
  const double radius = 0.2;
  const int k = 50;
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  const auto expected = test::expected_radiance(oracle, photons, hits, 2, k, radius);
  for (const EstimateTuning& tuning : test::tunings_of(test::device().info())) {
    CAPTURE(name_of(tuning.strategy));
    const Estimates estimates =
        Estimator(maps, scene, {.neighbours = k, .tuning = tuning, .area = AreaMode::disc})
            .estimate(hits);
    CHECK(test::worst_difference(estimates.radiance, expected) <= test::glossy_tolerance(k));
  }
}

}  // namespace photile::test
