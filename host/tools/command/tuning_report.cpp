#include "tools/command/tuning_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <utility>

namespace photile::app {
namespace {

/// Kinds of scenes whose kernels differ. Four lights stand for any number.
constexpr std::array scene_kinds = {
    std::pair{"one light, diffuse", SceneNeeds{.light_count = 1}},
    std::pair{"several lights, diffuse", SceneNeeds{.light_count = 4}},
    std::pair{"one light, glossy", SceneNeeds{.glossy = true, .light_count = 1}},
    std::pair{"several lights, glossy", SceneNeeds{.glossy = true, .light_count = 4}}};

std::string trial_line(const TuningTrial& trial, bool chosen) {
  const std::string time = std::isfinite(trial.microseconds_per_hit)
                               ? fmt::format("{:.3f} us", trial.microseconds_per_hit)
                               : "does not run";
  return fmt::format("{} {:>12}  {}", chosen ? '*' : ' ', time, tuning_words(trial.tuning));
}

}  // namespace

std::string tuning_words(const EstimateTuning& tuning) {
  std::string words{name_of(tuning.strategy)};
  if (tuning.strategy != EstimateStrategy::heap) {
    words += fmt::format(", {} wide", tuning.vector_width);
  }
  if (tuning.strategy == EstimateStrategy::select) {
    words += fmt::format(", {} hits a work-item", tuning.hits_per_item);
  }
  if (tuning.strategy == EstimateStrategy::lanes) {
    words += fmt::format(", {} hits a group, distances in {} memory", tuning.hits_per_item,
                         tuning.private_distances ? "private" : "local");
  }
  return words + fmt::format(", work-groups of {}, {:g} photons a cell", tuning.work_group_size,
                             tuning.photons_per_cell);
}

void tune_device(Device& device, int neighbours, Progress& progress) {
  std::cout << fmt::format("tuning {} ({}) for k = {}; * = chosen and stored\n", device.info().name,
                           device.info().platform, neighbours);
  for (const auto& [kind, needs] : scene_kinds) {
    const TuningResult result = tune_estimate(device, needs, neighbours, progress);
    std::cout << kind << ":\n";
    for (const TuningTrial& trial : result.trials) {
      std::cout << trial_line(trial, trial.tuning == result.best) << '\n';
    }
    std::cout.flush();
    store_tuning(device.info(), needs, result.best);
  }
}

}  // namespace photile::app
