// How far single precision may lie from the oracles.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "oracle/density_oracle.hpp"

namespace photile::reference {

/// Two photons tie where single precision may order them either way: squared distances are sums of
/// three products, each factor rounded once or twice, so they are right to 4 units of 2^-24, and
/// two of them may differ by 8.
inline constexpr double tie = 8.0 / (1 << 24);

/// Largest relative difference of an irradiance over a whole disc. Sums of k positive floats are
/// right to k units of 2^-24, the area to a few.
inline double estimate_tolerance(int k) { return (static_cast<double>(k) + 16.0) / (1 << 24); }

/// Whether the last photon of an estimate, the (k - 1)-th or for k = 1 the first, ties with the
/// next or with the radius: then it is another's estimate that single precision may give.
inline bool estimate_is_tied(const DensityOracle& oracle, const glm::dvec3& hit,
                             std::uint32_t oriented_face, int k, double radius) {
  const auto last = static_cast<std::size_t>(std::max(k - 1, 1));
  const auto near = oracle.nearest(hit, oriented_face, k + 1, radius * (1 + tie));
  const std::vector<double>& squared = near.squared_distance;
  const auto tied = [](double a, double b) { return std::abs(a - b) <= tie * b; };
  return (squared.size() > last && tied(squared[last - 1], squared[last])) ||
         std::any_of(squared.begin(), squared.end(),
                     [&](double distance) { return tied(distance, radius * radius); });
}

}  // namespace photile::reference
