// Photon maps of a pass on every device, and the estimates made with them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "render/device_estimators.hpp"

namespace photile {

/// Makes estimates of hits not depend on the hits beside them: work-items that estimate several
/// make use of one for the next, whose sums then have another order.
void estimate_each_alone(std::span<EstimateParameters> levels, const Device& device);

class MapEstimators {
 public:
  /// References are kept.
  ///   maps           the same on each device
  ///   levels         ascending in k: hits choose one, each its own
  ///   layer_powers   by which hits choose their own k
  /// Errors: as Estimator.
  MapEstimators(std::span<Device> devices, const Scene& scene, std::vector<PhotonMaps> maps,
                std::span<const EstimateParameters> levels, std::span<const double> layer_powers);

  /// Of hits in any order. Errors: as DeviceEstimators.
  Estimates estimate(const PrimaryHits& hits);

  /// Per sided triangle, as PhotonMaps has it: the order of hits.
  std::span<const std::uint32_t> map_of() const { return maps_.front().map_of(); }

  /// k, or the most that a hit has where it has its own.
  int neighbours() const { return neighbours_.back(); }
  /// Of the maps, metres.
  double radius() const { return maps_.front().parameters().radius; }

  /// Each device's part of all hits so far.
  std::vector<double> shares() const { return estimators_.back().shares(); }

 private:
  Estimates estimate_in_order(const PrimaryHits& hits);

  std::vector<PhotonMaps> maps_;  ///< on each device
  std::vector<int> neighbours_;   ///< of each level
  std::span<const double> layer_powers_;
  std::vector<DeviceEstimators> estimators_;  ///< of each level; they keep references to the maps
};

}  // namespace photile
