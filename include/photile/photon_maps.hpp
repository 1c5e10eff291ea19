// Photon maps on the device: one 2D uniform grid per oriented face (Graglia et al. 2012,
// section 2.2) or patch.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

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
  /// Whether a CPU device keeps maps in large pages of memory. They make estimates of millions of
  /// hits quicker; clearing them takes longer where the system has none ready.
  bool large_pages = true;
};

struct PhotonMapStatistics {
  std::uint64_t photons = 0;
  std::uint64_t references = 0;            ///< records over all maps; references / photons = copies
  std::uint64_t maps = 0;                  ///< that hold a photon
  std::uint64_t normal_filtered_maps = 0;  ///< of these, maps whose queries filter by normal
  std::uint64_t cells = 0;
  std::uint64_t largest_map = 0;              ///< records
  std::vector<std::uint32_t> map_sizes = {};  ///< photons of each map that holds one, ascending
  std::uint64_t pages = 0;          ///< runs of maps that are moved to and from the device
  std::uint64_t device_bytes = 0;   ///< of all pages, wherever they lie
  std::uint64_t spilled_bytes = 0;  ///< of these, on the host when the build was done
  double seconds = 0;
};

class PhotonMaps;
namespace maps {
struct MapStore;
const MapStore& store_of(const PhotonMaps& maps);
PhotonMaps maps_in(std::unique_ptr<MapStore> store);
}  // namespace maps

/// Photon maps of every oriented face, or of patches of them (NeighbourGroups::patches). A photon
/// is entered in the maps of its group that lie within the radius of the photon itself. Build is
/// deterministic: the same input gives the same bits on every run, device thread count and CPU
/// runtime.
class PhotonMaps {
 public:
  /// Builds on the device. Errors: UsageError for a radius beyond the groups'; DeviceMemoryError
  /// when the device's memory does not suffice even page by page; Interrupted.
  ///   requested   per map of the groups: 1 for those to build, whose contents do not depend on
  ///               the others; empty: all
  PhotonMaps(Device& device, const Scene& scene, const Photons& photons,
             const NeighbourGroups& groups, const PhotonMapParameters& parameters,
             Progress& progress = Progress::none(), std::span<const std::uint8_t> requested = {});
  /// Builds the maps of photons that are not needed afterwards: their arrays are released as soon
  /// as the maps hold copies, so that both are never in memory as a whole.
  PhotonMaps(Device& device, const Scene& scene, Photons&& photons, const NeighbourGroups& groups,
             const PhotonMapParameters& parameters, Progress& progress = Progress::none(),
             std::span<const std::uint8_t> requested = {});
  ~PhotonMaps();
  PhotonMaps(PhotonMaps&&) noexcept;
  PhotonMaps& operator=(PhotonMaps&&) noexcept;

  const PhotonMapStatistics& statistics() const;
  const PhotonMapParameters& parameters() const;
  Device& device() const;
  /// Per oriented face: its map, `none` where no photon comes near. Empty where
  /// that is the oriented face itself.
  std::span<const std::uint32_t> map_of() const;

 private:
  friend const maps::MapStore& maps::store_of(const PhotonMaps& maps);
  friend PhotonMaps maps::maps_in(std::unique_ptr<maps::MapStore> store);
  explicit PhotonMaps(std::unique_ptr<maps::MapStore> store);
  /// `consumed`: the same photons where they may be given back, else null.
  void build(Device& device, const Scene& scene, const Photons& photons, Photons* consumed,
             const NeighbourGroups& groups, const PhotonMapParameters& parameters,
             std::span<const std::uint8_t> requested, Progress& progress);

  std::unique_ptr<maps::MapStore> store_;
};

}  // namespace photile
