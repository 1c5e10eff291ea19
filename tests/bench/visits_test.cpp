// What searches of trees look at, as the benches count it.
#include "structures/visits.hpp"

#include <catch2/catch.hpp>

#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {

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

}  // namespace photile::test
