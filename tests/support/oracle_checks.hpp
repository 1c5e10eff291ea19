// Neighbours and irradiance of every map structure and mode against the double-precision oracle.
#pragma once

#include <catch2/catch.hpp>
#include <initializer_list>

#include "estimates_comparison.hpp"
#include "neighbour_comparison.hpp"
#include "test_device.hpp"

namespace photile::test {

/// Checks the neighbours (ties excepted, see count_differences) and, with `irradiance`, the
/// estimate to within estimate_tolerance. Estimates are right only where no tie is: leave them out
/// where many photons are equally far.
inline void check_against_oracle(const Scene& scene, const Photons& photons,
                                 const PrimaryHits& hits, double radius,
                                 std::initializer_list<int> neighbour_counts, bool irradiance) {
  const std::size_t lights = scene.lights.size();
  for (const MapMode mode : {MapMode::naive, MapMode::triangle, MapMode::patch}) {
    const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
    const reference::DensityOracle oracle(
        scene, photons,
        mode == MapMode::naive ? reference::PhotonFilter::naive : reference::PhotonFilter::grouped,
        60);
    for (const MapStructure structure : all_map_structures) {
      if (is_global(structure) && mode != MapMode::triangle) continue;
      const PhotonMaps maps(device(), scene, photons, groups, {radius, 4, structure});
      for (const int k : neighbour_counts) {
        CAPTURE(name_of(structure), static_cast<int>(mode), k, radius, photons.size());
        Estimator estimator(maps, scene, {.neighbours = k, .area = AreaMode::disc});
        CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                                static_cast<float>(radius)) == 0);
        if (!irradiance) continue;
        const Estimates estimates = estimator.estimate(hits);
        CHECK(worst_difference(by_light(estimates.irradiance, estimates, lights),
                               expected_irradiance(oracle, hits, k, radius)) <=
              estimate_tolerance(k));
      }
    }
  }
}

}  // namespace photile::test
