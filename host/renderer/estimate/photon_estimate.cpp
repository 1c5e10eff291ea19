#include "estimate/photon_estimate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "estimate/load_balance.hpp"
#include "estimate/map_order.hpp"
#include "photile/statistics.hpp"

namespace photile::estimate {
namespace {

/// Neighbours in the lists of one time: 16 MB.
constexpr std::size_t listed_at_a_time = std::size_t{1} << 22;

}  // namespace

std::vector<PhotonMaps> build_maps_on_each(std::span<Device> devices, const Scene& scene,
                                           Photons photons, const NeighbourGroups& groups,
                                           const PhotonMapParameters& parameters,
                                           Progress& progress,
                                           std::span<const std::uint8_t> requested) {
  std::vector<std::optional<PhotonMaps>> built(devices.size());
  for_each_device(devices, progress, [&](std::size_t i, Progress& shared) {
    if (devices.size() == 1) {
      built[i].emplace(devices[i], scene, std::move(photons), groups, parameters, shared,
                       requested);
    } else {
      built[i].emplace(devices[i], scene, std::as_const(photons), groups, parameters, shared,
                       requested);
    }
  });
  std::vector<PhotonMaps> maps;
  for (auto& one : built) maps.push_back(std::move(*one));
  return maps;
}

PhotonEstimate::PhotonEstimate(std::span<Device> devices, const Scene& scene, Parts parts)
    : devices_(devices),
      maps_(std::move(parts.maps)),
      neighbours_(static_cast<std::size_t>(parts.parameters.neighbours)),
      balance_(devices.size()),
      seen_(std::move(parts.seen)) {
  for (const PhotonMaps& maps : *maps_) estimators_.emplace_back(maps, scene, parts.parameters);
}

LightTable PhotonEstimate::at(const PrimaryHits& points, const Progress&) {
  LightTable result;
  std::vector<double> seconds(devices_.size());
  std::vector<LightTable> parts(devices_.size());
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t count = balance_.round(points.size() - first);
    const std::vector<std::size_t> cuts = balance_.cuts(count);
    for_each_device(devices_, Progress::none(), [&](std::size_t i, Progress&) {
      const Stopwatch stopwatch;
      parts[i] = estimators_[i].estimate(points, first + cuts[i], cuts[i + 1] - cuts[i]);
      seconds[i] = stopwatch.seconds();
    });
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      result.append(std::move(parts[i]));
      balance_.record(i, cuts[i + 1] - cuts[i], seconds[i]);
    }
    balance_.end_round();
    first += count;
  }
  if (seen_) leave_out_hidden(points, result);
  return result;
}

void PhotonEstimate::leave_out_hidden(const PrimaryHits& points, LightTable& result) {
  const std::vector<std::uint32_t> beside =
      seen_->beside_something(points, result, maps_->front().parameters().radius);
  const std::size_t lists = std::max<std::size_t>(1, listed_at_a_time / neighbours_);
  for (std::size_t first = 0; first < beside.size(); first += lists) {
    const std::span<const std::uint32_t> chosen =
        std::span(beside).subspan(first, std::min(lists, beside.size() - first));
    const NeighbourLists near = estimators_.front().nearest(reordered(points, chosen));
    seen_->leave_out_hidden(points, chosen, near, result);
  }
}

}  // namespace photile::estimate
