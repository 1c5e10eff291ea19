// Neighbours and irradiance of every map structure and mode against the double-precision oracle.
#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <initializer_list>
#include <span>

#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"

namespace photile::test {

/// What photon maps of a mode are made of, and what they must find.
struct MapsUnderTest {
  const Scene& scene;
  const Photons& photons;
  const PrimaryHits& hits;
  double radius;
  MapMode mode;
  NeighbourGroups groups;
  reference::DensityOracle oracle;

  MapsUnderTest(const Scene& of_scene, const Photons& of_photons, const PrimaryHits& at_hits,
                double search_radius, MapMode map_mode)
      : scene(of_scene),
        photons(of_photons),
        hits(at_hits),
        radius(search_radius),
        mode(map_mode),
        groups(find_map_groups(scene, photons, mode, {radius, 60})),
        oracle(scene, photons,
               mode == MapMode::naive ? reference::PhotonFilter::naive
                                      : reference::PhotonFilter::grouped,
               60) {}

  bool has(const structures::Structure& structure) const {
    return mode == MapMode::triangle || !structure.global;
  }

  /// Checks the neighbours (ties excepted, see count_differences) and, with `irradiance`, the
  /// estimate to within estimate_tolerance, where it is not tied. Leave it out where many photons
  /// are equally far.
  void check(const structures::Structure& structure, std::span<const int> neighbour_counts,
             bool irradiance) const {
    const PhotonMaps maps =
        structures::build(structure, device(), scene, photons, groups, {radius, 4});
    for (const int k : neighbour_counts) {
      CAPTURE(structure.name, static_cast<int>(mode), k, radius, photons.size());
      Estimator estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc});
      CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                              static_cast<float>(radius)) == 0);
      if (!irradiance) continue;
      const LightTable estimates = estimator.estimate(hits);
      const auto found = by_light(estimates.irradiance, estimates, scene.lights.size());
      CHECK(worst_difference(found, expected(found, k)) <= estimate_tolerance(k));
    }
  }

 private:
  /// At hits whose estimate is tied, what was found.
  ExpectedEstimates expected(const std::vector<glm::vec3>& found, int k) const {
    ExpectedEstimates truth = expected_irradiance(oracle, hits, k, radius);
    for (std::size_t hit = 0; hit < truth.size(); ++hit) {
      if (!estimate_is_tied(oracle, hits.position[hit], hits.oriented_face[hit], k, radius)) {
        continue;
      }
      const auto first = found.begin() + static_cast<std::ptrdiff_t>(hit * truth[hit].size());
      std::copy_n(first, truth[hit].size(), truth[hit].begin());
    }
    return truth;
  }
};

/// The grid, a tree and no structure at all. What all of them find is told by the tests of
/// neighbours (tests/estimate/neighbours_vs_oracle_test.cpp); the kernels of each take long to
/// compile.
inline constexpr std::array checked_structures{"uniform-grid", "kdtree-3d", "brute-force"};

/// Checks every mode of the maps.
inline void check_against_oracle(const Scene& scene, const Photons& photons,
                                 const PrimaryHits& hits, double radius,
                                 std::initializer_list<int> neighbour_counts, bool irradiance) {
  for (const MapMode mode : {MapMode::naive, MapMode::triangle, MapMode::patch}) {
    const MapsUnderTest maps(scene, photons, hits, radius, mode);
    for (const char* const name : checked_structures) {
      const structures::Structure& structure = structures::named(name);
      if (maps.has(structure)) {
        maps.check(structure, {neighbour_counts.begin(), neighbour_counts.size()}, irradiance);
      }
    }
  }
}

}  // namespace photile::test
