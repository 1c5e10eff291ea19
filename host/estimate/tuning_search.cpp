#include "estimate/tuning_search.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "estimate/specialisation.hpp"
#include "estimate/tuning.hpp"

namespace photile::estimate {
namespace {

constexpr std::array tried_photons_per_cell = {2.0f, 4.0f, 8.0f};
constexpr std::array tried_hits_per_item = {1, 8, 16, 64};
constexpr std::array tried_hits_of_lanes = {1, 4, 16};
constexpr std::array tried_work_group_sizes = {1, 16, 64, 256};

bool groups_fit(const EstimateTuning& tuning, const SceneNeeds& needs, int neighbours) {
  return specialise(tuning, needs, neighbours).work_group_size ==
         static_cast<std::size_t>(tuning.work_group_size);
}

void fit_groups(EstimateTuning& tuning, const SceneNeeds& needs, int neighbours) {
  const auto& sizes = tried_work_group_sizes;
  for (auto size = sizes.rbegin(); size != sizes.rend(); ++size) {
    if (groups_fit(tuning, needs, neighbours)) return;
    tuning.work_group_size = std::min(tuning.work_group_size, *size);
  }
}

std::vector<EstimateTuning> other_strategies(const EstimateTuning& from, const SceneNeeds& needs,
                                             int neighbours) {
  std::vector<EstimateTuning> tunings;
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    EstimateTuning tuning = from;
    tuning.strategy = strategy;
    if (from.strategy == EstimateStrategy::lanes) {
      tuning.vector_width = 1;
      tuning.work_group_size = EstimateTuning{}.work_group_size;
      tuning.private_distances = false;
    }
    if (strategy == EstimateStrategy::lanes) {
      // Where work-items hold vectors they are no lanes: such kernels crawl on CPUs.
      if (from.vector_width > 1) continue;
      tuning.vector_width = tuning.work_group_size = 32;
    }
    if (strategy == EstimateStrategy::tile) {
      if (needs.glossy) continue;  // estimated one by one, as `select` does
      if (tuning.vector_width == 1) tuning.vector_width = 8;  // a tile of one hit is none
    }
    if (strategy == from.strategy) continue;
    if (specialise(tuning, needs, neighbours).strategy != strategy) continue;
    fit_groups(tuning, needs, neighbours);
    tunings.push_back(tuning);
  }
  return tunings;
}

}  // namespace

std::vector<EstimateTuning> alternatives(TuningParameter parameter, const EstimateTuning& from,
                                         const SceneNeeds& needs, int neighbours) {
  std::vector<EstimateTuning> tunings;
  const auto add = [&](auto EstimateTuning::*member, const auto& values) {
    for (const auto value : values) {
      if (from.*member == value) continue;
      tunings.push_back(from);
      tunings.back().*member = value;
    }
  };
  switch (parameter) {
    case TuningParameter::strategy:
      return other_strategies(from, needs, neighbours);
    case TuningParameter::photons_per_cell:
      add(&EstimateTuning::photons_per_cell, tried_photons_per_cell);
      break;
    case TuningParameter::vector_width:
      if (from.strategy == EstimateStrategy::heap) break;  // uses no vectors
      if (from.strategy == EstimateStrategy::lanes) {
        add(&EstimateTuning::vector_width, lane_widths);
        for (EstimateTuning& tuning : tunings) tuning.work_group_size = tuning.vector_width;
        break;
      }
      add(&EstimateTuning::vector_width, vector_widths);
      if (from.strategy == EstimateStrategy::tile) {
        std::erase_if(tunings,
                      [](const EstimateTuning& tuning) { return tuning.vector_width == 1; });
      }
      break;
    case TuningParameter::hits_per_item:
      if (from.strategy == EstimateStrategy::select) {
        add(&EstimateTuning::hits_per_item, tried_hits_per_item);
      } else if (from.strategy == EstimateStrategy::lanes) {
        add(&EstimateTuning::hits_per_item, tried_hits_of_lanes);
      }
      break;
    case TuningParameter::work_group_size:
      if (from.strategy == EstimateStrategy::lanes) break;  // that of its width
      add(&EstimateTuning::work_group_size, tried_work_group_sizes);
      std::erase_if(tunings, [&](const EstimateTuning& tuning) {
        return !groups_fit(tuning, needs, neighbours);
      });
      break;
    case TuningParameter::private_distances:
      if (from.strategy == EstimateStrategy::lanes) {
        add(&EstimateTuning::private_distances, std::array{false, true});
      }
      break;
  }
  // Those of `from`, too: a large k needs smaller groups than what is shipped.
  for (EstimateTuning& tuning : tunings) fit_groups(tuning, needs, neighbours);
  return tunings;
}

EstimateTuning search_tuning(const EstimateTuning& start, const SceneNeeds& needs, int neighbours,
                             const TuningCost& cost, double least_gain) {
  std::vector<std::pair<EstimateTuning, double>> known;
  const auto cost_of = [&](const EstimateTuning& tuning) {
    for (const auto& [other, time] : known) {
      if (other == tuning) return time;
    }
    return known.emplace_back(tuning, cost(tuning)).second;
  };
  EstimateTuning best = start;
  double least = cost_of(start);
  for (bool gained = true; gained;) {
    gained = false;
    for (const TuningParameter parameter : all_tuning_parameters) {
      for (const EstimateTuning& tuning : alternatives(parameter, best, needs, neighbours)) {
        const double time = cost_of(tuning);
        if (!(time < least * (1 - least_gain))) continue;
        best = tuning;
        least = time;
        gained = true;
      }
    }
  }
  return best;
}

}  // namespace photile::estimate
