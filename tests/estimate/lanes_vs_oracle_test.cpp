// The kernels whose lanes are the work-items of a group, as on GPUs: the oracle's neighbours, and
// the estimates of a work-item's own vectors but for the order of sums.
#include <catch2/catch.hpp>

#include "estimate/specialisation.hpp"
#include "estimate/tuning.hpp"
#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.3;

EstimateTuning lanes(int width) { return {EstimateStrategy::lanes, width, 4, width}; }

struct Subject {
  Scene scene;
  Photons photons;
  PrimaryHits hits;

  Subject(Scene built, std::size_t photon_count, std::size_t hit_count)
      : scene(std::move(built)),
        photons(uniform_photons(scene, photon_count, 91)),
        hits(uniform_hits(scene, hit_count, 92)) {}

  PhotonMaps maps() const {
    return {device(), scene, photons, find_neighbour_groups(scene, {radius, 60}), {radius, 4}};
  }
};

Scene torus(std::size_t lights) {
  Scene scene = empty_scene(lights);
  add_torus(scene, 1.0f, 0.4f, 16, 8);
  return scene;
}

Estimates estimate(const PhotonMaps& maps, const Subject& subject, const EstimateTuning& tuning,
                   int k) {
  return Estimator(maps, subject.scene, {.neighbours = k, .tuning = tuning, .area = AreaMode::disc})
      .estimate(subject.hits);
}

}  // namespace

TEST_CASE("lanes find the oracle's neighbours for any k and number of hits", "[slow]") {
  const int width = GENERATE(32, 64);
  const std::size_t hits = GENERATE(1u, 61u);
  const Subject subject(torus(1), 6000, hits);
  const PhotonMaps maps = subject.maps();
  const reference::DensityOracle oracle(subject.scene, subject.photons,
                                        reference::PhotonFilter::grouped, 60);
  for (const int k : {1, 2, 31, 50, 65, 200, 1000}) {
    CAPTURE(width, hits, k);
    Estimator estimator(maps, subject.scene, {.neighbours = k, .tuning = lanes(width)});
    CHECK(count_differences(subject.hits, estimator.nearest(subject.hits), oracle, subject.photons,
                            radius) == 0);
  }
}

TEST_CASE("lanes differ from vectors in the order of sums alone", "[slow]") {
  // PoCL 3.1 compiles the estimate of a group, with its barriers in loops, for many minutes.
  if (device().info().is_pocl) return;
  const Subject subject(torus(3), 6000, 60);
  const PhotonMaps maps = subject.maps();
  constexpr int k = 50;
  const Estimates of_lanes = estimate(maps, subject, lanes(32), k);
  const Estimates of_vectors = estimate(maps, subject, {EstimateStrategy::select, 16, 4, 16}, k);
  REQUIRE(of_lanes.irradiance.size() == of_vectors.irradiance.size());
  // A sum of k positive numbers is right to k - 1 roundings, in any order.
  constexpr double bound = 2.0 * k * 0x1p-24;
  double worst = 0;
  for (std::size_t i = 0; i < of_lanes.irradiance.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double a = of_lanes.irradiance[i][c], b = of_vectors.irradiance[i][c];
      if (a != b) worst = std::max(worst, std::abs(a - b) / b);
    }
  }
  CHECK(worst <= bound);
}

}  // namespace photile::test
