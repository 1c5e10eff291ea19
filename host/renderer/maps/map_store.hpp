// Photon maps as they lie on the device.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "device/context.hpp"
#include "maps/resident_maps.hpp"
#include "photile/device/constants.h"
#include "photile/photon_maps.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {
class Query;
struct QueryParameters;
}  // namespace photile::estimate

namespace photile::maps {

/// The state behind PhotonMaps.
struct MapStore {
  MapStore(Device& device, const SceneNeeds& needs, const PhotonMapParameters& parameters)
      : device(&device), needs(needs), parameters(parameters), pages(device::context_of(device)) {}

  Device* device;
  SceneNeeds needs;
  PhotonMapParameters parameters;
  PhotonMapStatistics statistics;
  mutable ResidentMaps
      pages;  ///< maps without photons may lie in no page; using a page may move others
  /// Per oriented face; `none` where no photon comes near. Empty where that is the map itself.
  std::vector<std::uint32_t> map_of;
  double angle_degrees = 0;           ///< largest angle between normals of neighbours
  double cos_angle = 0;               ///< its cosine
  bool naive = false;                 ///< maps hold the photons of their own triangle only
  std::vector<std::uint32_t> landed;  ///< per oriented face: photons that landed there
  std::vector<glm::vec3> normals;     ///< per oriented face; only if a page has record_normal

  /// Makes the queries of these maps where they are not grids, but structures that grids are
  /// compared with (bench/structures). Empty for grids.
  std::function<std::unique_ptr<estimate::Query>(const MapStore&, const estimate::QueryParameters&)>
      make_query;

  /// The maps of hits [first, first + count).
  std::vector<std::uint32_t> maps_of(const PrimaryHits& hits, std::size_t first,
                                     std::size_t count) const;
};

/// Work-items of a group in every kernel of build and estimate.
inline constexpr std::size_t work_group_size = 64;

/// The group size of the kernels whose work-items work together in local memory.
inline constexpr std::size_t group_size = PHOTILE_COOPERATIVE_GROUP;

/// Whether such kernels are used: on all devices except CPUs, where work-items of a group run in
/// turn, and devices with smaller groups.
inline bool works_in_groups(const DeviceInfo& device) {
  return device.type != DeviceType::cpu && device.max_work_group_size >= group_size;
}

/// The definitions with which programs with such kernels are built.
inline device::Defines group_defines(const DeviceInfo& device) {
  device::Defines defines;
  if (works_in_groups(device)) defines.set("IN_GROUPS");
  return defines;
}

}  // namespace photile::maps
