// A map that is cut into tiles gives every hit the neighbours within the whole radius.
#include <algorithm>
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

TEST_CASE("estimates by tiles that leave out parts of rows have the bits of the whole map's") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {3.36f, 0, 0}, {0, 3.36f, 0}, 1);
  const Photons photons = test::uniform_photons(scene, 3'000, 93, false);
  const PrimaryHits hits = test::uniform_hits(scene, 1'000, 94, false);
  const NeighbourGroups groups = find_map_groups(scene, photons, MapMode::patch, {radius, 60});
  // Tiles that are narrow need small cells.
  const PhotonMapParameters parameters{.radius = radius, .photons_per_cell = 0.25f};
  const EstimateParameters estimated{.neighbours = 20, .area = AreaMode::disc};
  const PhotonMaps whole(test::device(), scene, photons, groups, parameters);
  DeviceOptions options;
  options.memory_bytes = 150'000;
  Device small(options);
  const PhotonMaps tiled(small, scene, photons, groups, parameters);
  const maps::MapStore& store = maps::store_of(tiled);
  bool gaps = false;  // entries without a photon
  for (std::size_t i = 0; i < store.pages.size(); ++i) {
    const maps::MapPage& page = store.pages.use(i);
    std::vector<std::uint32_t> photon_of(page.entry_photon.size());
    device::context_of(small).read(page.entry_photon, std::span(photon_of));
    gaps |= std::find(photon_of.begin(), photon_of.end(), none) != photon_of.end();
  }
  REQUIRE(gaps);
  CHECK(Estimator(tiled, scene, estimated).estimate(hits).irradiance ==
        Estimator(whole, scene, estimated).estimate(hits).irradiance);
}

}  // namespace photile::test
