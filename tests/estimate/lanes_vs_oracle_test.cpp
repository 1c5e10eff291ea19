// The kernels whose lanes are the work-items of a group, as on GPUs: the neighbours and estimates
// of the double-precision oracle, and those of a work-item's own vectors but for the order of sums.
#include <catch2/catch.hpp>

#include "estimate/specialisation.hpp"
#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "oracle/clipped_area.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.3;
constexpr int k = 50;

EstimateTuning lanes(int width) { return {EstimateStrategy::lanes, width, 4, width}; }

struct Subject {
  Scene scene;
  Photons photons;
  PrimaryHits hits;
  PhotonMaps maps;

  Subject(Scene built, std::size_t hit_count)
      : scene(std::move(built)),
        photons(uniform_photons(scene, 6000, 91)),
        hits(uniform_hits(scene, hit_count, 92)),
        maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}), {radius, 4}) {
    if (needs_of(scene).glossy) add_lobes(hits, scene, 93);
  }

  reference::DensityOracle oracle() const {
    return {scene, photons, reference::PhotonFilter::grouped, 60};
  }

  Estimates estimate(const EstimateTuning& tuning, int neighbours, AreaMode area) const {
    return Estimator(maps, scene, {.neighbours = neighbours, .tuning = tuning, .area = area})
        .estimate(hits);
  }
};

Scene torus(std::size_t lights, bool glossy) {
  Scene scene = empty_scene(lights);
  if (glossy) {
    scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
    scene.materials[0].roughness = 0.3f;
  }
  add_torus(scene, 1.0f, 0.4f, 16, 8);
  return scene;
}

/// Largest relative difference of two lists of positive numbers.
double relative_difference(const std::vector<glm::vec3>& values,
                           const std::vector<glm::vec3>& expected) {
  REQUIRE(values.size() == expected.size());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double a = values[i][c], b = expected[i][c];
      if (a != b) worst = std::max(worst, std::abs(a - b) / b);
    }
  }
  return worst;
}

/// Estimates over whole discs by `lanes` against the oracle's.
void check_estimates(const Subject& subject, int width, int neighbours) {
  const std::size_t lights = subject.scene.lights.size();
  CAPTURE(width, neighbours, lights, subject.hits.size());
  const Estimates estimates = subject.estimate(lanes(width), neighbours, AreaMode::disc);
  const reference::DensityOracle oracle = subject.oracle();
  CHECK(worst_difference(by_light(estimates.irradiance, estimates, lights),
                         expected_irradiance(oracle, subject.hits, neighbours, radius)) <=
        estimate_tolerance(neighbours));
  if (!needs_of(subject.scene).glossy) return;
  CHECK(worst_difference(by_light(estimates.radiance, estimates, lights),
                         expected_radiance(oracle, subject.photons, subject.hits, lights,
                                           neighbours, radius)) <= glossy_tolerance(neighbours));
}

}  // namespace

TEST_CASE("lanes find the oracle's neighbours for any k and number of hits", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t hits = GENERATE(1u, 61u);
  const Subject subject(torus(1, false), hits);
  const reference::DensityOracle oracle = subject.oracle();
  for (const int neighbours : {1, 2, 31, 50, 65, 200, 1000}) {
    CAPTURE(width, hits, neighbours);
    Estimator estimator(subject.maps, subject.scene,
                        {.neighbours = neighbours, .tuning = lanes(width)});
    CHECK(count_differences(subject.hits, estimator.nearest(subject.hits), oracle, subject.photons,
                            radius) == 0);
  }
}

TEST_CASE("lanes estimate the oracle's irradiance for any k and number of hits", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t hits = GENERATE(1u, 61u);
  const Subject subject(torus(1, false), hits);
  for (const int neighbours : {1, 2, 31, 50, 65, 200, 1000}) {
    check_estimates(subject, width, neighbours);
  }
}

TEST_CASE("lanes estimate the oracle's irradiance of several lights and of many", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t lights = GENERATE(3u, 20u);
  check_estimates(Subject(torus(lights, false), 61), width, k);
}

TEST_CASE("lanes estimate the oracle's glossy radiance", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t lights = GENERATE(2u, 20u);
  check_estimates(Subject(torus(lights, true), 61), width, k);
}

TEST_CASE("lanes clip discs as the oracle does", "[slow]") {
  const int width = GENERATE(32, 64);
  Scene scene = torus(1, false);
  // Edges and a step within reach of most hits.
  add_plate(scene, {-1.5f, -1.5f, -0.5f}, {3, 0, 0}, {0, 3, 0.1f}, 4);
  add_plate(scene, {-0.5f, -0.5f, -0.4f}, {1, 0, 0}, {0, 1, 0}, 1);
  const Subject subject(std::move(scene), 120);
  const SurfaceIndex surface =
      index_surface(subject.scene, landed_on(subject.scene, subject.photons), radius, 60);
  const reference::ClippedArea area(subject.scene, subject.photons, surface, 60);
  const reference::DensityOracle oracle = subject.oracle();
  ExpectedEstimates expected;
  for (std::size_t i = 0; i < subject.hits.size(); ++i) {
    expected.push_back(oracle.irradiance(area, subject.hits.position[i],
                                         subject.hits.oriented_face[i], k,
                                         static_cast<float>(radius), DensityKernel::constant));
  }
  const Estimates estimates = subject.estimate(lanes(width), k, AreaMode::clipped);
  // The oracle's discs are polygons: clipped_vs_oracle_test.cpp.
  CHECK(worst_difference(estimates.irradiance, expected) <= 1e-3);
}

TEST_CASE("lanes differ from vectors in the order of sums alone") {
  const Subject subject(torus(3, false), 60);
  const Estimates of_lanes = subject.estimate(lanes(32), k, AreaMode::disc);
  const Estimates of_vectors =
      subject.estimate({EstimateStrategy::select, 16, 4, 16}, k, AreaMode::disc);
  // A sum of k positive numbers is right to k - 1 roundings, in any order.
  constexpr double bound = 2.0 * k * 0x1p-24;
  CHECK(relative_difference(of_lanes.irradiance, of_vectors.irradiance) <= bound);
  // Another order it is: equal bits would say that one backend was compared with itself.
  CHECK(relative_difference(of_lanes.irradiance, of_vectors.irradiance) > 0);
}

TEST_CASE("lanes that take hits in turn estimate the bits of each alone", "[slow]") {
  const Subject subject(torus(3, false), 62);
  EstimateTuning tuning = lanes(32);
  const Estimates in_turn = subject.estimate(tuning, k, AreaMode::clipped);
  tuning.hits_per_item = 1;
  CHECK(subject.estimate(tuning, k, AreaMode::clipped).irradiance == in_turn.irradiance);
}

TEST_CASE("distances in private memory give the bits of those in local memory", "[slow]") {
  const std::size_t lights = GENERATE(1u, 20u);
  // At k = 1,000 a block does not fit and is walked again.
  const int neighbours = GENERATE(50, 1000);
  const Subject subject(torus(lights, false), 61);
  EstimateTuning tuning = lanes(32);
  const Estimates local = subject.estimate(tuning, neighbours, AreaMode::disc);
  tuning.private_distances = true;
  CHECK(subject.estimate(tuning, neighbours, AreaMode::disc).irradiance == local.irradiance);
}

}  // namespace photile::test
