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
    : MapEstimators(devices, scene, nullptr, layer_powers) {
  Parts parts{std::move(maps), {levels.begin(), levels.end()}};
  make_ = [&parts] { return std::move(parts); };
  built();
}

MapEstimators::MapEstimators(std::span<Device> devices, const Scene& scene,
                             std::function<Parts()> make, std::span<const double> layer_powers)
    : devices_(devices), scene_(scene), layer_powers_(layer_powers), make_(std::move(make)) {}

MapEstimators::Built& MapEstimators::built() const {
  if (built_) return *built_;
  Parts parts = make_();
  auto built = std::make_unique<Built>();
  built->maps = std::move(parts.maps);
  for (const EstimateParameters& level : parts.levels) {
    built->neighbours.push_back(level.neighbours);
    built->estimators.emplace_back(devices_, built->maps, scene_, level);
  }
  built_ = std::move(built);
  make_ = nullptr;
  return *built_;
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
  for (DeviceEstimators& one : built().estimators) by_level.push_back(one.estimate(hits));
  return by_level.size() == 1
             ? std::move(by_level.front())
             : estimates_of_least_error(std::move(by_level), built().neighbours, layer_powers_);
}

}  // namespace photile
