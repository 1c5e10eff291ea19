// The structures beside the grid, and what they visit.
#include <catch2/catch.hpp>

#include "estimates_comparison.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "structures/visits.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

// What structures are registered, and what those of other kinds than the grid refuse or cannot
// lose. Their answers are compared with the oracle's in tests/estimate.

constexpr double radius = 0.2;

Scene torus() {
  Scene scene = test::empty_scene();
  test::add_torus(scene, 1.0f, 0.4f, 48, 24);
  return scene;
}

TEST_CASE("a structure is found by its name, and an unknown name lists those there are") {
  CHECK(structures::named("uniform-grid").is_grid());
  CHECK(structures::named("kdtree-global").global);
  CHECK_THROWS_WITH(structures::named("octree"), Catch::Matchers::Contains("octree") &&
                                                     Catch::Matchers::Contains("hashed-grid"));
}

TEST_CASE(
    "a structure over all photons knows no naive maps, and one that does not fit is refused") {
  const Scene scene = torus();
  const Photons photons = test::uniform_photons(scene, 20'000, 61);
  DeviceOptions options;
  options.memory_bytes = 1'000'000;  // an eighth of it is the largest buffer
  Device small(options);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const structures::Structure& structure : structures::all()) {
    if (!structure.global) continue;
    CAPTURE(structure.name);
    CHECK_THROWS_AS(
        structures::build(structure, test::device(), scene, photons, naive_groups(scene), {radius}),
        UsageError);
    CHECK_THROWS_AS(structures::build(structure, small, scene, photons, groups, {radius}),
                    DeviceError);
  }
}

TEST_CASE("trees of maps that lie in several pages give the same bits as in one") {
  const Scene scene = torus();
  const Photons photons = test::uniform_photons(scene, 20'000, 62);
  const PrimaryHits hits = test::uniform_hits(scene, 300, 63);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const char* const name : {"kdtree-2d", "kdtree-3d"}) {
    const auto estimate = [&](Device& device, std::uint64_t least_pages) {
      const PhotonMaps maps =
          structures::build(structures::named(name), device, scene, photons, groups, {radius});
      CHECK(maps.statistics().pages >= least_pages);
      return Estimator(maps, scene, {.neighbours = 50, .area = AreaMode::disc})
          .estimate(hits)
          .irradiance;
    };
    Device device;
    const auto expected = estimate(device, 1);
    DeviceOptions options;
    options.memory_bytes = device.peak_allocated_bytes() / 4;
    Device small(options);
    CAPTURE(name, options.memory_bytes);
    CHECK(estimate(small, 2) == expected);
    CHECK(small.peak_allocated_bytes() <= options.memory_bytes);
  }
}

// What searches of trees look at, as the benches count it.

TEST_CASE("a search for all photons computes the distance of each once") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  constexpr std::size_t count = 100;
  constexpr double radius = 2;  // metres: all of the plate
  const Photons photons = test::uniform_photons(scene, count, 1, false);
  const PrimaryHits hits = test::uniform_hits(scene, 10, 2, false);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const std::string_view structure : {"kdtree-3d", "kdtree-left-balanced"}) {
    CAPTURE(structure);
    const PhotonMaps maps = structures::build(structures::named(structure), test::device(), scene,
                                              photons, groups, {radius, 4});
    const structures::Visits visits = structures::count_visits(maps, hits, 2 * count);
    CHECK(visits.photons == count);
    CHECK(visits.nodes >= 1);
  }
}

}  // namespace
}  // namespace photile::test
