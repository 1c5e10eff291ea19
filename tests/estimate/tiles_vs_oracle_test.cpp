// A map that is cut into tiles gives every hit the neighbours within the whole radius.
#include <catch2/catch.hpp>
#include <cmath>

#include "maps/map_store.hpp"
#include "neighbour_comparison.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.25;  // metres

/// Bins around a tile that hits within `reach` of its border need.
double bins_within(const maps::MapTiling& tiling, double reach) {
  return std::ceil(reach / (double{tiling.grid().cell_height} * tiling.bin_height()));
}

}  // namespace

TEST_CASE("tiles find the oracle's neighbours up to the radius, on either side of every border") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {3.36f, 0, 0}, {0, 3.36f, 0}, 1);
  const Photons photons = test::uniform_photons(scene, 3'000, 91, false);
  const PrimaryHits hits = test::uniform_hits(scene, 4'000, 92, false);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  DeviceOptions options;
  options.memory_bytes = 200'000;
  Device small(options);
  const PhotonMaps maps(small, scene, photons,
                        find_map_groups(scene, photons, MapMode::patch, {radius, 60}),
                        {.radius = radius, .photons_per_cell = 0.318f});
  REQUIRE_FALSE(maps::store_of(maps).tilings.empty());
  for (const auto& [map, tiling] : maps::store_of(maps).tilings) {
    // A reach too short by a tenth would show.
    REQUIRE(bins_within(tiling, 0.9 * radius) < bins_within(tiling, radius));
  }
  // More than there are within the radius, so that all of those are wanted.
  Estimator estimator(maps, scene, {200, 0});
  CHECK(test::count_differences(hits, estimator.nearest(hits), oracle, photons, radius) == 0);
}

}  // namespace photile::test
