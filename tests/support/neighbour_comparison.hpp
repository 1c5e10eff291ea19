// Compares the kernels' neighbours with the double-precision oracle's.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "oracle/density_oracle.hpp"
#include "photile/estimator.hpp"

namespace photile::test {

/// Two photons tie where single precision may order them either way: squared distances are sums of
/// three products, each factor rounded once or twice, so they are right to 4 units of 2^-24, and
/// two of them may differ by 8.
inline constexpr double tie = 8.0 / (1 << 24);

/// Whether the last photon of an estimate, the (k - 1)-th or for k = 1 the first, ties with the
/// next or with the radius: then it is another's estimate that single precision may give.
inline bool estimate_is_tied(const reference::DensityOracle& oracle, const glm::dvec3& hit,
                             std::uint32_t sided_triangle, int k, double radius) {
  const auto last = static_cast<std::size_t>(std::max(k - 1, 1));
  const auto near = oracle.nearest(hit, sided_triangle, k + 1, radius * (1 + tie));
  const std::vector<double>& squared = near.squared_distance;
  const auto tied = [](double a, double b) { return std::abs(a - b) <= tie * b; };
  return (squared.size() > last && tied(squared[last - 1], squared[last])) ||
         std::any_of(squared.begin(), squared.end(),
                     [&](double distance) { return tied(distance, radius * radius); });
}

/// Hits whose neighbours differ by more than ties.
inline std::size_t count_differences(const PrimaryHits& hits, const NeighbourLists& found,
                                     const reference::DensityOracle& oracle, const Photons& photons,
                                     double radius) {
  const auto k = static_cast<std::size_t>(found.k);
  std::size_t differences = 0;
  for (std::size_t hit = 0; hit < hits.size(); ++hit) {
    const glm::dvec3 position = hits.position[hit];
    const auto expected = oracle.nearest(position, hits.sided_triangle[hit], found.k, radius);
    const std::set<std::uint32_t> wanted(expected.photons.begin(), expected.photons.end());
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
    std::set_symmetric_difference(wanted.begin(), wanted.end(), got.begin(), got.end(),
                                  std::back_inserter(only_one));
    const bool only_ties = std::all_of(only_one.begin(), only_one.end(), is_tied);
    const bool radius_agrees = std::abs(double{found.squared_radius[hit]} - border) <= tie * border;
    // As many neighbours, unless photons tie with the search radius itself.
    const bool same_number = wanted.size() == got.size() || border == radius * radius;
    if (!only_ties || !radius_agrees || !same_number) ++differences;
  }
  return differences;
}

}  // namespace photile::test
