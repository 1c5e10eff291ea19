// Photon maps on the device: one 2D uniform grid per sided triangle (Graglia et al. 2012,
// section 5).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "photile/defaults.hpp"
#include "photile/device.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile {

struct PhotonMapParameters {
  double radius = 0;  ///< metres, > 0: no neighbour is farther; at most the groups' radius
  float photons_per_cell = defaults::photons_per_cell;  ///< aimed at
};

struct PhotonMapStatistics {
  std::uint64_t photons = 0;
  std::uint64_t references = 0;   ///< entries over all maps; references / photons = copies
  std::uint64_t maps = 0;         ///< sided triangles whose map holds a photon
  std::uint64_t cells = 0;
  std::uint64_t largest_map = 0;  ///< entries
  std::uint64_t pages = 0;        ///< map pages on the device
  std::uint64_t device_bytes = 0;
  double seconds = 0;
};

namespace maps {
struct UniformGrid;  // host/maps/uniform_grid.hpp
}

/// Photon maps of every sided triangle. A photon is entered by reference in the maps of its group
/// that lie within the radius of the photon itself. Build is deterministic: the same input gives the
/// same bits on every run, device thread count and CPU runtime.
class PhotonMaps {
 public:
  /// Builds on the device. Errors: UsageError for a radius beyond the groups'; DeviceError when the
  /// device's memory does not suffice; Interrupted.
  PhotonMaps(Device& device, const Scene& scene, const Photons& photons,
             const NeighbourGroups& groups, const PhotonMapParameters& parameters,
             Progress& progress = Progress::none());
  ~PhotonMaps();
  PhotonMaps(PhotonMaps&&) noexcept;
  PhotonMaps& operator=(PhotonMaps&&) noexcept;

  const PhotonMapStatistics& statistics() const;
  const PhotonMapParameters& parameters() const;
  Device& device() const;

  const maps::UniformGrid& grid() const { return *grid_; }

 private:
  std::unique_ptr<maps::UniformGrid> grid_;
};

}  // namespace photile
