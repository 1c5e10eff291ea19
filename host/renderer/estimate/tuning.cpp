#include "estimate/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "photile/errors.hpp"

namespace photile {

std::string_view name_of(EstimateStrategy strategy) {
  switch (strategy) {
    case EstimateStrategy::select:
      return "select";
    case EstimateStrategy::lanes:
      return "lanes";
  }
  return "unknown";
}

EstimateTuning shipped_tuning(const DeviceInfo& device) {
  const bool lanes =
      device.type != DeviceType::cpu && device.max_work_group_size >= estimate::lane_widths.front();
  return shipped_tuning(device, lanes ? EstimateStrategy::lanes : EstimateStrategy::select);
}

EstimateTuning shipped_tuning(const DeviceInfo& device, EstimateStrategy strategy) {
  EstimateTuning tuning;
  tuning.strategy = strategy;
  if (strategy == EstimateStrategy::lanes) {
    // docs/kernels.md says by what arithmetic; no card has run them.
    constexpr int usual_width = 32;
    const auto& widths = estimate::lane_widths;
    const auto in_step = static_cast<int>(device.lanes);
    const bool is_width = std::find(widths.begin(), widths.end(), in_step) != widths.end();
    int width = is_width ? in_step : usual_width;
    while (width > widths.front() && static_cast<unsigned>(width) > device.max_work_group_size) {
      width /= 2;
    }
    tuning.vector_width = tuning.work_group_size = width;
    tuning.hits_per_item = 4;
  } else if (device.type == DeviceType::cpu) {
    tuning.vector_width = 16;
    tuning.hits_per_item = 16;
  }
  return tuning;
}

namespace estimate {

std::string tuning_problem(const EstimateTuning& tuning) {
  const auto is_one_of = [&](const auto& widths) {
    return std::find(widths.begin(), widths.end(), tuning.vector_width) != widths.end();
  };
  if (tuning.strategy == EstimateStrategy::lanes) {
    if (!is_one_of(lane_widths)) {
      return fmt::format("lanes of {} work-items: must be 16, 32 or 64", tuning.vector_width);
    }
  } else if (!is_one_of(vector_widths)) {
    return fmt::format("vector width {}: must be 1, 4, 8 or 16", tuning.vector_width);
  }
  if (tuning.hits_per_item < 1 || tuning.hits_per_item > max_hits_per_item) {
    return fmt::format("{} hits per work-item: must be between 1 and {}", tuning.hits_per_item,
                       max_hits_per_item);
  }
  if (tuning.work_group_size < 1 || tuning.work_group_size > max_work_group_size) {
    return fmt::format("work-groups of {}: must be between 1 and {}", tuning.work_group_size,
                       max_work_group_size);
  }
  return {};
}

}  // namespace estimate
}  // namespace photile
