// Compares the kernels' neighbours with the double-precision oracle's.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "oracle/density_oracle.hpp"
#include "oracle/rounding.hpp"
#include "photile/estimator.hpp"

namespace photile::test {

using reference::estimate_is_tied;
using reference::tie;

/// Hits whose neighbours differ by more than ties.
inline std::size_t count_differences(const PrimaryHits& hits, const NeighbourLists& found,
                                     const reference::DensityOracle& oracle, const Photons& photons,
                                     double radius) {
  const auto k = static_cast<std::size_t>(found.k);
  std::size_t differences = 0;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const glm::dvec3 position = hits.position[hit];
    const auto expected = oracle.nearest(position, hits.oriented_face[hit], found.k, radius);
    const std::set<std::uint32_t> requested(expected.photons.begin(), expected.photons.end());
    std::set<std::uint32_t> got;
    for (std::size_t i = 0; i < k; ++i) {
      const std::uint32_t photon = found.photons[hit * k + i];
      if (photon != none && !got.insert(photon).second) ++differences;  // twice in one list
    }
    const double border = expected.squared_radius;
    const auto is_tied = [&](std::uint32_t photon) {
      const glm::dvec3 offset = glm::dvec3(photons.position[photon]) - position;
      return std::abs(glm::dot(offset, offset) - border) <= tie * border;
    };
    std::vector<std::uint32_t> only_one;
    std::set_symmetric_difference(requested.begin(), requested.end(), got.begin(), got.end(),
                                  std::back_inserter(only_one));
    const bool only_ties = std::all_of(only_one.begin(), only_one.end(), is_tied);
    const bool radius_agrees = std::abs(double{found.squared_radius[hit]} - border) <= tie * border;
    // Both find as many neighbours, unless photons tie with the search radius itself.
    const bool same_number = requested.size() == got.size() || border == radius * radius;
    if (!only_ties || !radius_agrees || !same_number) ++differences;
  }
  return differences;
}

}  // namespace photile::test
