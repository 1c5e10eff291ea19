// The tunings that there are.
#pragma once

#include <array>
#include <string>

#include "photile/estimator.hpp"

namespace photile::estimate {

inline constexpr std::array vector_widths = {1, 4, 8, 16};
inline constexpr std::array lane_widths = {16, 32, 64};  ///< of EstimateStrategy::lanes
inline constexpr int max_hits_per_item = 64;
inline constexpr int max_work_group_size = 256;

/// "" for a tuning that kernels exist for, else what is wrong with it.
std::string tuning_problem(const EstimateTuning& tuning);

}  // namespace photile::estimate
