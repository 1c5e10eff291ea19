// Photon maps and their estimators on several devices.
#pragma once

#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/photon_maps.hpp"
#include "photile/primary_hits.hpp"
#include "photile/progress.hpp"
#include "render/load_balance.hpp"

namespace photile {

/// Builds the same maps on every device, all at once; for one alone, photons are given back on the
/// way. Errors: as PhotonMaps, see for_each_device.
///   wanted   as PhotonMaps has it
std::vector<PhotonMaps> build_maps_on_each(std::span<Device> devices, const Scene& scene,
                                           Photons photons, const NeighbourGroups& groups,
                                           const PhotonMapParameters& parameters,
                                           Progress& progress,
                                           std::span<const std::uint8_t> wanted = {});

/// Estimates batches of hits on every device at once. On devices of one kind the result is that of
/// one device, bit for bit, however the hits are shared.
class DeviceEstimators {
 public:
  /// `maps`: those of devices[i] at i. Errors: as Estimator.
  DeviceEstimators(std::span<Device> devices, std::span<const PhotonMaps> maps, const Scene& scene,
                   const EstimateParameters& parameters);

  /// Errors: as Estimator, see for_each_device.
  Estimates estimate(const PrimaryHits& hits);

  /// Of the first device: the same on all. Errors: as Estimator.
  NeighbourLists nearest(const PrimaryHits& hits) { return estimators_.front().nearest(hits); }

  /// Each device's part of all hits so far.
  std::vector<double> shares() const { return balance_.shares(); }

 private:
  void estimate_round(const PrimaryHits& hits, std::size_t first, std::size_t count,
                      Estimates& result);

  std::span<Device> devices_;
  std::vector<Estimator> estimators_;
  LoadBalance balance_;
};

}  // namespace photile
