#include "support/estimate_check.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iostream>
#include <numeric>

#include "oracle/kernel_weights.hpp"
#include "oracle/rounding.hpp"

namespace photile::bench {
namespace {

/// Photons that the oracle goes through in a second or two.
constexpr std::size_t affordable_photons = std::size_t{1} << 27;
constexpr std::size_t least_checked = 16, most_checked = 256;

/// Areas that are clipped by polygons in double precision and by floats on the device differ by
/// this part of the whole disc (tests/estimate/clipped_vs_oracle_test.cpp).
constexpr double clipping = 1e-4;

std::vector<std::uint32_t> indices(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

/// Evenly spaced.
std::vector<std::uint32_t> some_of(std::span<const std::uint32_t> index, std::size_t photons) {
  const std::size_t requested = std::clamp(affordable_photons / std::max<std::size_t>(photons, 1),
                                           least_checked, most_checked);
  const std::size_t step = std::max<std::size_t>((index.size() + requested - 1) / requested, 1);
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < index.size(); i += step) chosen.push_back(index[i]);
  return chosen;
}

/// Where a hit is in `of`, ascending; empty: all hits.
std::size_t place_of(std::uint32_t hit, std::span<const std::uint32_t> of) {
  if (of.empty()) return hit;
  return static_cast<std::size_t>(std::lower_bound(of.begin(), of.end(), hit) - of.begin());
}

}  // namespace

EstimateCheck::EstimateCheck(const reference::DensityOracle& oracle, std::size_t photons,
                             const TimedEstimate& estimate, const PrimaryHits& hits)
    : EstimateCheck(oracle, photons, estimate, hits, indices(hits.size())) {}

EstimateCheck::EstimateCheck(const reference::DensityOracle& oracle, std::size_t photons,
                             const TimedEstimate& estimate, const PrimaryHits& hits,
                             std::span<const std::uint32_t> index)
    : index_(some_of(index, photons)), truths_(index_.size()) {
  for (const std::uint32_t i : index_) {
    hits_.position.push_back(hits.position[i]);
    hits_.oriented_face.push_back(hits.oriented_face[i]);
  }
  const double radius = static_cast<float>(estimate.radius);  // as kernels have it
  const DensityKernel kernel = kernel_used(estimate.kernel, estimate.k);
  tbb::parallel_for(std::size_t{0}, index_.size(), [&](std::size_t i) {
    const glm::dvec3 hit(hits.position[index_[i]]);
    const std::uint32_t on = hits.oriented_face[index_[i]];
    const auto irradiance = [&](DensityKernel of) {
      return estimate.surface
                 ? oracle.irradiance(*estimate.surface, hit, on, estimate.k, radius, of)
                 : oracle.irradiance(hit, on, estimate.k, radius, of);
    };
    Truth& truth = truths_[i];
    truth.squared_radius = oracle.nearest(hit, on, estimate.k, radius).squared_radius;
    truth.tied = reference::estimate_is_tied(oracle, hit, on, estimate.k, radius);
    truth.irradiance = irradiance(kernel);
    // A weight is right to a few units of 2^-24, however small it is: the sum to so many of what it
    // would be were all weights 1.
    const double disc = std::sqrt(truth.squared_radius);
    const double whole = glm::pi<double>() * truth.squared_radius;
    const auto area = [&](DensityKernel of) {
      return estimate.surface ? estimate.surface->area(hit, on, disc, of)
                              : whole * reference::mean_weight(of);
    };
    const double to_unweighted = area(DensityKernel::constant) / area(kernel);
    const double relative = reference::estimate_tolerance(estimate.k) +
                            (estimate.surface ? clipping * whole / area(kernel) : 0.0);
    for (const glm::dvec3& unweighted : irradiance(DensityKernel::constant)) {
      truth.tolerance.push_back(relative * to_unweighted * unweighted);
    }
  });
}

std::uint64_t EstimateCheck::count_faults(const std::string& timed, Estimator& estimator,
                                          const LightTable& estimates) const {
  const std::uint64_t faults = irradiances_that_differ(estimates.irradiance) +
                               radii_that_differ(estimator.nearest(hits_).squared_radius, index_);
  if (faults > 0) print_fault(timed, faults);
  return faults;
}

std::uint64_t EstimateCheck::irradiances_that_differ(std::span<const glm::vec3> irradiance,
                                                     std::span<const std::uint32_t> of) const {
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const Truth& truth = truths_[i];
    if (truth.tied) continue;
    const std::size_t lights = truth.irradiance.size();
    const auto found = irradiance.subspan(place_of(index_[i], of) * lights, lights);
    bool right = true;
    for (std::size_t light = 0; light < lights; ++light) {
      const glm::dvec3 difference = glm::abs(glm::dvec3(found[light]) - truth.irradiance[light]);
      // False for what is no number.
      right = right && glm::all(glm::lessThanEqual(difference, truth.tolerance[light]));
    }
    different += right ? 0 : 1;
  }
  return different;
}

std::uint64_t EstimateCheck::radii_that_differ(std::span<const float> squared_radius,
                                               std::span<const std::uint32_t> of) const {
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const double found = squared_radius[place_of(index_[i], of)];
    const double expected = truths_[i].squared_radius;
    different += std::abs(found - expected) <= reference::tie * expected ? 0 : 1;
  }
  return different;
}

void print_fault(const std::string& timed, std::uint64_t differences) {
  std::cerr << fmt::format("{}: {} values differ from the search in double precision\n", timed,
                           differences);
}

}  // namespace photile::bench
