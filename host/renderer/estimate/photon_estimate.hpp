// The photon estimate of points on every device: the method of the paper.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "estimate/load_balance.hpp"
#include "estimate/visible_photons.hpp"
#include "light/light_at_points.hpp"
#include "photile/estimator.hpp"
#include "photile/photon_maps.hpp"

namespace photile::estimate {

/// Builds the same maps on every device, all at once; with a single device, photons are released on
/// the way. Errors: as PhotonMaps, see for_each_device.
///   requested   as PhotonMaps has it
std::vector<PhotonMaps> build_maps_on_each(std::span<Device> devices, const Scene& scene,
                                           Photons photons, const NeighbourGroups& groups,
                                           const PhotonMapParameters& parameters,
                                           Progress& progress,
                                           std::span<const std::uint8_t> requested = {});

/// Light by the k nearest photons of each point, found on every device at once. On devices of one
/// kind the result is that of one device, bit for bit, however the points are shared.
class PhotonEstimate : public light::LightAtPoints {
 public:
  struct Parts {
    std::shared_ptr<const std::vector<PhotonMaps>> maps;  ///< the same on each device
    EstimateParameters parameters;
    /// Decides which photons of these maps are visible from a point: hidden ones do not count.
    /// Null: all count.
    std::shared_ptr<const VisiblePhotons> seen = nullptr;
  };
  /// References are kept.
  /// Errors: as Estimator.
  PhotonEstimate(std::span<Device> devices, const Scene& scene, Parts parts);

  LightTable at(const PrimaryHits& points, const Progress& progress) override;

  /// Per oriented face, as in PhotonMaps.
  std::span<const std::uint32_t> map_of() const { return maps_->front().map_of(); }

  /// Each device's part of all points so far.
  std::vector<double> fractions() const { return balance_.fractions(); }

 private:
  /// Removes photons that are hidden from their points from the estimates.
  void leave_out_hidden(const PrimaryHits& points, LightTable& result);

  std::span<Device> devices_;
  std::shared_ptr<const std::vector<PhotonMaps>> maps_;  ///< on each device
  std::vector<Estimator> estimators_;                    ///< one for each device
  std::size_t neighbours_;
  LoadBalance balance_;
  std::shared_ptr<const VisiblePhotons> seen_;
};

}  // namespace photile::estimate
