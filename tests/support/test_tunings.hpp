// The tunings that tests of the estimate try.
#pragma once

#include <vector>

#include "photile/estimator.hpp"

namespace photile::test {

/// What a device ships with, and each other strategy that it may run. CPUs compile the kernels of
/// lanes for minutes: they run them where they pose as GPUs, and in tests of lanes alone.
inline std::vector<EstimateTuning> tunings_of(const DeviceInfo& device) {
  std::vector<EstimateTuning> tunings;
  const EstimateStrategy shipped = shipped_tuning(device).strategy;
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    if (strategy == EstimateStrategy::lanes && shipped != strategy) continue;
    tunings.push_back(shipped_tuning(device, strategy));
    if (!tunings.back().shuffles) continue;
    tunings.push_back(tunings.back());
    tunings.back().shuffles = false;
  }
  return tunings;
}

}  // namespace photile::test
