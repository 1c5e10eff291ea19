#include "render/map_estimators.hpp"

#include <utility>

#include "estimate/map_order.hpp"
#include "render/neighbour_choice.hpp"

namespace photile {

void estimate_each_alone(std::span<EstimateParameters> levels, const Device& device) {
  for (EstimateParameters& level : levels) {
    EstimateTuning tuning = level.tuning.value_or(shipped_tuning(device.info()));
    tuning.strategy = EstimateStrategy::select;
    tuning.hits_per_item = 1;
    level.tuning = tuning;
  }
}

MapEstimators::MapEstimators(std::span<Device> devices, const Scene& scene,
                             std::vector<PhotonMaps> maps,
                             std::span<const EstimateParameters> levels,
                             std::span<const double> layer_powers)
    : maps_(std::move(maps)), layer_powers_(layer_powers) {
  for (const EstimateParameters& level : levels) {
    neighbours_.push_back(level.neighbours);
    estimators_.emplace_back(devices, maps_, scene, level);
  }
}

Estimates MapEstimators::estimate(const PrimaryHits& hits) {
  std::vector<std::uint32_t> maps = hits.sided_triangle;
  if (!map_of().empty()) {
    for (std::uint32_t& map : maps) map = map_of()[map];
  }
  // Hits may have the order of other maps. Devices share runs of hits, which they cut between maps.
  const std::vector<std::uint32_t> order = estimate::order_by_map(maps);
  return order.empty() ? estimate_in_order(hits)
                       : estimate::restored(estimate_in_order(estimate::reordered(hits, 0, order)),
                                            order, layer_powers_.size());
}

Estimates MapEstimators::estimate_in_order(const PrimaryHits& hits) {
  std::vector<Estimates> by_level;
  for (DeviceEstimators& one : estimators_) by_level.push_back(one.estimate(hits));
  return by_level.size() == 1
             ? std::move(by_level.front())
             : estimates_of_least_error(std::move(by_level), neighbours_, layer_powers_);
}

}  // namespace photile
