#include "render/map_estimators.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "estimate/map_order.hpp"
#include "render/neighbour_choice.hpp"

namespace photile {
namespace {

/// Parts of what is looked at; each goes through all photons.
constexpr std::size_t parts_in_sight = 2;
/// Lists of neighbours at a time: 26 MB of them at k = 100.
constexpr std::size_t hits_looked_at_together = std::size_t{1} << 16;

}  // namespace

MapEstimators::MapEstimators(std::span<Device> devices, const Scene& scene, Parts parts,
                             std::span<const double> layer_powers)
    : MapEstimators(devices, scene, nullptr, layer_powers) {
  built_.push_back(built_of(std::move(parts)));
}

MapEstimators::MapEstimators(std::span<Device> devices, const Scene& scene,
                             std::function<Parts()> make, std::span<const double> layer_powers)
    : devices_(devices), scene_(scene), layer_powers_(layer_powers), make_(std::move(make)) {}

MapEstimators::MapEstimators(std::span<Device> devices, const Scene& scene, const Patches& patches,
                             MakeSome make, std::span<const double> layer_powers)
    : devices_(devices),
      scene_(scene),
      layer_powers_(layer_powers),
      patches_(&patches),
      make_some_(std::move(make)),
      part_of_(patches.empty() ? 2 * scene.triangle_count() : 2 * patches.count(), none) {}

void MapEstimators::look_at(std::span<const std::uint32_t> sided_triangles) {
  if (!patches_) return;
  std::vector<std::uint8_t> wanted(part_of_.size(), 0);
  bool any = false;
  for (const std::uint32_t sided : sided_triangles) {
    const std::uint32_t map = patches_->map(sided);
    if (part_of_[map] != none) continue;
    wanted[map] = 1;
    any = true;
  }
  if (!any && !built_.empty()) return;
  if (built_.size() >= parts_in_sight) {
    std::transform(part_of_.begin(), part_of_.end(), wanted.begin(),
                   [](std::uint32_t part) { return part == none ? 1 : 0; });
  }
  built_.push_back(built_of(make_some_(wanted)));
  for (std::size_t map = 0; map < wanted.size(); ++map) {
    if (wanted[map] != 0) part_of_[map] = static_cast<std::uint32_t>(built_.size() - 1);
  }
}

std::unique_ptr<MapEstimators::Built> MapEstimators::built_of(Parts parts) const {
  auto built = std::make_unique<Built>();
  built->maps = std::move(parts.maps);
  built->seen = std::move(parts.seen);
  for (const EstimateParameters& level : parts.levels) {
    built->neighbours.push_back(level.neighbours);
    built->estimators.emplace_back(devices_, built->maps, scene_, level);
  }
  return built;
}

MapEstimators::Built& MapEstimators::built() const {
  if (built_.empty()) built_.push_back(built_of(make_()));
  make_ = nullptr;
  return *built_.front();
}

Estimates MapEstimators::estimate(const PrimaryHits& hits) {
  if (!owners_) return estimate_here(hits);
  return owners_->estimate(hits, [&](const PrimaryHits& own) { return estimate_here(own); });
}

Estimates MapEstimators::estimate_same(const PrimaryHits& hits) {
  if (!owners_) return estimate_here(hits);
  return owners_->estimate_same(hits, [&](const PrimaryHits& own) { return estimate_here(own); });
}

Estimates MapEstimators::estimate_here(const PrimaryHits& hits) {
  look_at(hits.sided_triangle);
  if (!patches_) return estimate_by(built(), hits);
  if (built_.size() == 1) return estimate_by(*built_.front(), hits);
  std::vector<std::uint32_t> part_of_hit;
  for (const std::uint32_t sided : hits.sided_triangle) {
    part_of_hit.push_back(part_of_[patches_->map(sided)]);
  }
  std::vector<std::uint32_t> order(hits.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return part_of_hit[a] < part_of_hit[b];
  });
  Estimates all;
  for (auto first = order.begin(); first != order.end();) {
    const std::uint32_t part = part_of_hit[*first];
    const auto last = std::find_if(first, order.end(),
                                   [&](std::uint32_t hit) { return part_of_hit[hit] != part; });
    all.append(estimate_by(*built_[part], estimate::reordered(hits, 0, {first, last})));
    first = last;
  }
  return estimate::restored(std::move(all), order, layer_powers_.size());
}

Estimates MapEstimators::estimate_by(Built& built, const PrimaryHits& hits) const {
  const auto in_order = [&](const PrimaryHits& ordered) {
    std::vector<Estimates> by_level;
    for (DeviceEstimators& one : built.estimators)
      by_level.push_back(estimate_by(one, built.seen.get(), ordered));
    return by_level.size() == 1
               ? std::move(by_level.front())
               : estimates_of_least_error(std::move(by_level), built.neighbours, layer_powers_);
  };
  const std::span<const std::uint32_t> map_of = built.maps.front().map_of();
  std::vector<std::uint32_t> maps = hits.sided_triangle;
  if (!map_of.empty()) {
    for (std::uint32_t& map : maps) map = map_of[map];
  }
  // Hits may have the order of other maps. Devices share runs of hits, which they cut between maps.
  const std::vector<std::uint32_t> order = estimate::order_by_map(maps);
  return order.empty() ? in_order(hits)
                       : estimate::restored(in_order(estimate::reordered(hits, 0, order)), order,
                                            layer_powers_.size());
}

Estimates MapEstimators::estimate_by(DeviceEstimators& estimators, const SeenPhotons* seen,
                                     const PrimaryHits& hits) const {
  Estimates estimates = estimators.estimate(hits);
  if (!seen) return estimates;
  const std::vector<std::uint32_t> lit =
      SeenPhotons::lit(estimates, hits.size(), layer_powers_.size());
  for (std::size_t first = 0; first < lit.size(); first += hits_looked_at_together) {
    const std::span<const std::uint32_t> chosen =
        std::span(lit).subspan(first, std::min(hits_looked_at_together, lit.size() - first));
    const NeighbourLists near = estimators.nearest(estimate::reordered(hits, 0, chosen));
    seen->leave_out_hidden(hits, chosen, near, estimates);
  }
  return estimates;
}

}  // namespace photile
