// How the estimate runs on a device: which kernel, how wide. Speed only; but float sums depend on
// their order, so the last bits of a picture depend on the tuning.
#pragma once

#include <array>
#include <string_view>

#include "photile/device.hpp"

namespace photile {

/// How the k nearest photons are selected. All find the same neighbours.
enum class EstimateStrategy {
  select,  ///< distances of a block of cells in one pass, the k-th by radix selection; no list
  lanes    ///< as `select`, by a group of work-items that are the lanes of a vector: for GPUs
};

inline constexpr std::array all_estimate_strategies = {EstimateStrategy::select,
                                                       EstimateStrategy::lanes};

/// "select", "lanes".
std::string_view name_of(EstimateStrategy strategy);

struct EstimateTuning {
  EstimateStrategy strategy = EstimateStrategy::select;
  int vector_width = 1;  ///< floats per vector: 1, 4, 8 or 16; of `lanes` 16, 32 or 64 work-items
  /// Neighbouring hits that a work-item, or a group of `lanes`, estimates in turn.
  int hits_per_item = 1;
  /// Work-items; fewer where their private memory would be too much. That of `lanes` is the width.
  int work_group_size = 64;
  /// `lanes` only: whether each keeps its distances in private memory, not in local. The same bits.
  bool private_distances = false;

  friend bool operator==(const EstimateTuning&, const EstimateTuning&) = default;
};

/// What estimators use unless asked for another: vector width 16 on every CPU, whatever its own
/// width, so that pictures agree in every bit between CPUs; elsewhere `lanes`, of as many
/// work-items as the device runs in step, or of 32 where it does not say.
EstimateTuning shipped_tuning(const DeviceInfo& device);

/// With this strategy, as wide as suits it on the device.
EstimateTuning shipped_tuning(const DeviceInfo& device, EstimateStrategy strategy);

}  // namespace photile
