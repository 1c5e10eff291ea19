#include "render/device_estimators.hpp"

#include <optional>
#include <utility>

#include "photile/statistics.hpp"
#include "render/for_each_device.hpp"

namespace photile {

std::vector<PhotonMaps> build_maps_on_each(std::span<Device> devices, const Scene& scene,
                                           Photons photons, const NeighbourGroups& groups,
                                           const PhotonMapParameters& parameters,
                                           Progress& progress,
                                           std::span<const std::uint8_t> wanted) {
  std::vector<std::optional<PhotonMaps>> built(devices.size());
  for_each_device(devices, progress, [&](std::size_t i, Progress& shared) {
    if (devices.size() == 1) {
      built[i].emplace(devices[i], scene, std::move(photons), groups, parameters, shared, wanted);
    } else {
      built[i].emplace(devices[i], scene, std::as_const(photons), groups, parameters, shared,
                       wanted);
    }
  });
  std::vector<PhotonMaps> maps;
  for (auto& one : built) maps.push_back(std::move(*one));
  return maps;
}

DeviceEstimators::DeviceEstimators(std::span<Device> devices, std::span<const PhotonMaps> maps,
                                   const Scene& scene, const EstimateParameters& parameters)
    : devices_(devices), balance_(devices.size()) {
  for (const PhotonMaps& one : maps) estimators_.emplace_back(one, scene, parameters);
}

Estimates DeviceEstimators::estimate(const PrimaryHits& hits) {
  Estimates result;
  for (std::size_t first = 0; first < hits.size();) {
    const std::size_t count = balance_.round(hits.size() - first);
    estimate_round(hits, first, count, result);
    first += count;
  }
  return result;
}

void DeviceEstimators::estimate_round(const PrimaryHits& hits, std::size_t first, std::size_t count,
                                      Estimates& result) {
  const std::vector<std::size_t> cuts = balance_.cuts(count);
  std::vector<double> seconds(devices_.size());
  std::vector<Estimates> parts(devices_.size());
  for_each_device(devices_, Progress::none(), [&](std::size_t i, Progress&) {
    const Stopwatch stopwatch;
    parts[i] = estimators_[i].estimate(hits, first + cuts[i], cuts[i + 1] - cuts[i]);
    seconds[i] = stopwatch.seconds();
  });
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    result.append(std::move(parts[i]));
    balance_.record(i, cuts[i + 1] - cuts[i], seconds[i]);
  }
  balance_.end_round();
}

}  // namespace photile
