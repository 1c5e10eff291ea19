// Photon maps as they lie on the device.
#pragma once

#include <cstddef>

#include "device/context.hpp"
#include "maps/resident_maps.hpp"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

/// The state behind PhotonMaps.
struct MapStore {
  MapStore(Device& device, const SceneNeeds& needs, const PhotonMapParameters& parameters)
      : device(&device), needs(needs), parameters(parameters), pages(device.context()) {}

  Device* device;
  SceneNeeds needs;
  PhotonMapParameters parameters;
  PhotonMapStatistics statistics;
  mutable ResidentMaps pages;  ///< maps without photons may lie in none; using one moves others
  std::vector<std::uint32_t> map_of;  ///< per sided triangle; empty where that is the map itself
  double cos_angle = 0;               ///< of the largest angle between normals
  std::vector<glm::vec3> normals;     ///< per sided triangle; only if a page has entry_normal
};

/// Work-items of a group in every kernel of build and estimate.
inline constexpr std::size_t work_group_size = 64;

}  // namespace photile::maps
