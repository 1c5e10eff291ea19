// The tunings that tests of the estimate try.
#pragma once

#include <vector>

#include "photile/estimate_tuning.hpp"

namespace photile::test {

/// What a device ships with, and each other strategy that it may run. CPUs compile the kernels of
/// lanes for minutes: they run them where they pose as GPUs, and in tests of lanes alone.
inline std::vector<EstimateTuning> tunings_of(const DeviceInfo& device) {
  std::vector<EstimateTuning> tunings;
  const EstimateTuning shipped = shipped_tuning(device);
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    if (strategy == EstimateStrategy::lanes && shipped.strategy != strategy) continue;
    EstimateTuning tuning = shipped;
    if (strategy != EstimateStrategy::lanes && shipped.strategy == EstimateStrategy::lanes) {
      tuning = {};
      if (strategy == EstimateStrategy::tile) tuning.vector_width = 8;
    }
    tuning.strategy = strategy;
    tunings.push_back(tuning);
  }
  return tunings;
}

}  // namespace photile::test
