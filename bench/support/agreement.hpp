// Whether two searches found the same.
#pragma once

#include <cstdint>
#include <span>

#include "photile/estimator.hpp"
#include "support/host_search.hpp"

namespace photile::bench {

/// Hits whose irradiance differs by more than `relative` from the reference's (largest component).
std::uint64_t count_irradiance_differences(std::span<const glm::vec3> irradiance,
                                           std::span<const glm::vec3> reference, double relative);

/// Hits whose squared radius differs by more than `relative` from the reference's.
std::uint64_t count_radius_differences(std::span<const float> squared_radius,
                                       std::span<const float> reference, double relative);

/// Every n-th hit, so that about `wanted` are left, in their order.
struct HitSample {
  PrimaryHits hits;
  std::vector<std::uint32_t> index;  ///< of each in the whole
};
HitSample sample_of(const PrimaryHits& hits, std::size_t wanted);

}  // namespace photile::bench
