// The structures beside the grid, and what they visit.
#include <numeric>

#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "photile/errors.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"
#include "structures/visits.hpp"
#include "support/estimate_check.hpp"
#include "support/rivals.hpp"
#include "support/turns.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

// What structures are registered, and what those of other kinds than the grid refuse or cannot
// lose. Their answers are compared with the oracle's in tests/estimate.

constexpr double radius = 0.2;

Scene torus() {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 48, 24);
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
  const Photons photons = uniform_photons(scene, 20'000, 61);
  DeviceOptions options;
  options.memory_bytes = 1'000'000;  // an eighth of it is the largest buffer
  Device small(options);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const structures::Structure& structure : structures::all()) {
    if (!structure.global) continue;
    CAPTURE(structure.name);
    CHECK_THROWS_AS(
        structures::build(structure, device(), scene, photons, naive_groups(scene), {radius}),
        UsageError);
    CHECK_THROWS_AS(structures::build(structure, small, scene, photons, groups, {radius}),
                    DeviceError);
  }
}

TEST_CASE("trees of maps that lie in several pages give the same bits as in one") {
  const Scene scene = torus();
  const Photons photons = uniform_photons(scene, 20'000, 62);
  const PrimaryHits hits = uniform_hits(scene, 300, 63);
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
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  constexpr std::size_t count = 100;
  constexpr double radius = 2;  // metres: all of the plate
  const Photons photons = uniform_photons(scene, count, 1, false);
  const PrimaryHits hits = uniform_hits(scene, 10, 2, false);
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  for (const std::string_view structure : {"kdtree-3d", "kdtree-left-balanced"}) {
    CAPTURE(structure);
    const PhotonMaps maps = structures::build(structures::named(structure), device(), scene,
                                              photons, groups, {radius, 4});
    const structures::Visits visits = structures::count_visits(maps, hits, 2 * count);
    CHECK(visits.photons == count);
    CHECK(visits.nodes >= 1);
  }
}

// The rivals of the benches, and the turns in which they are timed.

using namespace bench;

// What the grid is compared with finds what a search in double precision finds, in every variant,
// and nobody runs before the others have had as many turns.

constexpr double angle = 60;

/// By the lists of a variant, which are of photons in an order of its own: how many hits have
/// another radius than the oracle's, or not as many different photons.
std::size_t wrong_lists(const HostSearch& search, const PrimaryHits& hits,
                        std::span<const std::uint32_t> order, const SearchParameters& parameters,
                        const reference::DensityOracle& oracle) {
  ListAnswers found;
  search.nearest(hits, order, parameters, found);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto expected = oracle.nearest(hits.position[i], hits.oriented_face[i],
                                         static_cast<int>(parameters.k), parameters.radius);
    const auto row = std::span(found.photons).subspan(i * parameters.k, parameters.k);
    std::set<std::uint32_t> photons(row.begin(), row.end());
    photons.erase(none);
    const bool right = photons.size() == expected.photons.size() &&
                       std::abs(found.squared_radius[i] - expected.squared_radius) <=
                           tie * expected.squared_radius;
    wrong += right ? 0 : 1;
  }
  return wrong;
}

TEST_CASE(
    "every variant of every rival finds the oracle's neighbours, filtered where normals differ") {
  const bool curved = GENERATE(false, true);
  Scene scene = empty_scene();
  if (curved) {
    add_torus(scene, 1.0f, 0.4f, 24, 12);
  } else {
    add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
  }
  const Photons photons = uniform_photons(scene, 4'000, 71, curved);
  const PrimaryHits hits = uniform_hits(scene, 200, 72, curved);
  const NormalFilter filter(scene, angle);
  CHECK(filter.all_agree(photons.oriented_face, hits.oriented_face) != curved);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, angle);
  // The smaller radius holds fewer than k.
  for (const float radius : {0.5f, 0.03f}) {
    const SearchParameters parameters{20, radius};
    Rivals rivals(photons, filter, hits.oriented_face, 1);
    const EstimateCheck check(oracle, photons.size(), {20, radius}, hits);
    const auto libraries = rivals.at_their_best(hits, parameters);
    REQUIRE(libraries.size() == rival_versions().size());
    std::vector<std::uint32_t> order(hits.size());
    std::iota(order.rbegin(), order.rend(), 0u);
    for (const Rivals::Library& library : libraries) {
      double least = 0;
      for (const Rivals::Variant& variant : library.variants) {
        CAPTURE(library.name, variant.name, curved, radius);
        CHECK(wrong_lists(*variant.search, hits, order, parameters, oracle) == 0);
        DensityAnswers answers;
        variant.search->estimate(hits, order, parameters, answers);
        CHECK(check.irradiances_that_differ(answers.irradiance) == 0);
        CHECK(check.radii_that_differ(answers.squared_radius) == 0);
        CHECK(variant.seconds >= least);
        least = variant.seconds;
      }
    }
  }
}

TEST_CASE("contestants take turns, and their rows say what each round took") {
  std::string ran;
  const auto contestant = [&](const char* name, std::uint64_t wrong) {
    return Contestant{{{"structure", name}, {"queries", 10}, {"k", 5}},
                      [&ran, name] { ran += name; },
                      [wrong](nlohmann::json& row) {
                        row["finished"] = true;
                        return wrong;
                      }};
  };
  std::vector<Contestant> contestants{contestant("a", 0), contestant("b", 3)};
  CHECK(take_turns(contestants, {.most = 3, .all = true}) == 3);
  CHECK(ran == "abababab");
  for (const Contestant& one : contestants) {
    CHECK(one.row["finished"] == true);
    for (const char* const time : {"seconds", "processor seconds", "system seconds"}) {
      CHECK(one.row[time]["samples"].size() == 3);
    }
    CHECK_FALSE(one.row.contains("kernel seconds"));
  }
}

}  // namespace
}  // namespace photile::test
