// Whether two searches found the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "support/host_search.hpp"

namespace photile::bench {

/// Entries whose irradiance differs by more than `relative` from the reference's (largest
/// component).
std::vector<std::size_t> irradiance_differences(std::span<const glm::vec3> irradiance,
                                                std::span<const glm::vec3> reference,
                                                double relative);

/// Whether more than one photon lies on the rim of the disc, up to rounding. Then either may be the
/// k-th, whose flux is left out, and both sums are right. Looks at every photon.
bool has_tied_rim(const Photons& photons, const NormalFilter& filter, const glm::vec3& position,
                  std::uint32_t sided_triangle, float squared_radius);

/// Hits whose squared radius differs by more than `relative` from the reference's.
std::uint64_t count_radius_differences(std::span<const float> squared_radius,
                                       std::span<const float> reference, double relative);

}  // namespace photile::bench
