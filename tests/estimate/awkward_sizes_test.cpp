// Numbers of photons and hits that fit no work-group, vector or batch.
#include <catch2/catch.hpp>
#include <cstring>

#include "neighbour_comparison.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

Scene plate() {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
  return scene;
}

/// `count` hits that repeat those of `base`, in their order.
PrimaryHits repeat(const PrimaryHits& base, std::size_t count) {
  PrimaryHits hits;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * base.size() / count;
    hits.position.push_back(base.position[from]);
    hits.sided_triangle.push_back(base.sided_triangle[from]);
  }
  return hits;
}

}  // namespace

TEST_CASE("a hit's estimate is the same bits, however many hits are estimated with it") {
  const Scene scene = plate();
  const Photons photons = test::uniform_photons(scene, 4096, 81);
  const PrimaryHits base = test::uniform_hits(scene, 93, 82);
  // The last one is more than a batch.
  const std::size_t count =
      GENERATE(0u, 1u, 7u, 63u, 64u, 65u, 93u, 4096u, (std::size_t{1} << 20) + 1);
  const PrimaryHits hits = repeat(base, count);
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {0.2, 60}),
                        {0.2, 4});
  Estimator estimator(maps, scene, {16, 0});
  const Estimates expected = estimator.estimate(base);
  const Estimates estimates = estimator.estimate(hits);
  REQUIRE(estimates.irradiance.size() == count);
  std::size_t differences = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& alone = expected.irradiance[i * base.size() / count];
    differences += std::memcmp(&alone, &estimates.irradiance[i], sizeof alone) != 0;
  }
  CHECK(differences == 0);
}

TEST_CASE("neighbours equal the oracle's among 2^20 + 1 photons") {
  const Scene scene = plate();
  const Photons photons = test::uniform_photons(scene, (std::size_t{1} << 20) + 1, 83);
  const PrimaryHits hits = test::uniform_hits(scene, 17, 84);
  const double radius = 0.05;
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  for (const structures::Structure& structure : structures::all()) {
    if (!structure.global && structure.name != "uniform-grid") continue;
    const PhotonMaps maps =
        structures::build(structure, test::device(), scene, photons, groups, {radius, 4});
    for (const int k : {1, 50, 100'000}) {
      Estimator estimator(maps, scene, {k, 0});
      CAPTURE(structure.name, k);
      CHECK(test::count_differences(hits, estimator.nearest(hits), oracle, photons,
                                    static_cast<float>(radius)) == 0);
    }
  }
}

}  // namespace photile::test
