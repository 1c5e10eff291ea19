// Coordinate descent over tunings.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "photile/estimate_tuning.hpp"

namespace photile::estimate {

/// What a tuning consists of, in the order of the search: what changes most comes first.
enum class TuningParameter {
  strategy,
  photons_per_cell,
  vector_width,
  hits_per_item,
  work_group_size,
  private_distances
};

inline constexpr std::array all_tuning_parameters = {
    TuningParameter::strategy,        TuningParameter::photons_per_cell,
    TuningParameter::vector_width,    TuningParameter::hits_per_item,
    TuningParameter::work_group_size, TuningParameter::private_distances};

/// Tunings that differ from `from` in one parameter. Where another strategy or width needs more
/// private memory, its work-groups are the largest that may be. Left out is what would run the same
/// kernel in the same way, or work-groups that need more private memory than they may.
std::vector<EstimateTuning> alternatives(TuningParameter parameter, const EstimateTuning& from,
                                         const SceneNeeds& needs, int neighbours);

/// Time of a tuning, in any unit; infinite where it cannot run.
using TuningCost = std::function<double(const EstimateTuning&)>;

/// From `start` on, takes the best value of one parameter after the other until none gains. A
/// change must save `least_gain` of the cost: less is noise, and `start` is known to be good. Asks
/// for the cost of a tuning once. The full product would compile ten times as many programs.
EstimateTuning search_tuning(const EstimateTuning& start, const SceneNeeds& needs, int neighbours,
                             const TuningCost& cost, double least_gain);

}  // namespace photile::estimate
