// Drives the build kernels.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "maps/candidate_maps.hpp"
#include "maps/map_shapes.hpp"
#include "maps/map_store.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"

namespace photile::maps {

/// Builds one map per sided triangle or side of a patch: uniform grids, kd-trees, or plain lists of
/// photons. Fills the pages and statistics of `store`, whose device, needs and parameters are set.
///   spent    the same photons where their arrays may be given back on the way, else null
///   wanted   as PhotonMaps has it
void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          Photons* spent, const NeighbourGroups& groups,
                          std::span<const std::uint8_t> wanted, Progress& progress);

/// Where maps lie, and which photons may enter them.
struct MapPlan {
  CandidateMaps candidates;
  MapShapes surfaces;           ///< of pairs of maps
  std::vector<float> crowding;  ///< per map, see photon_crowding
  float reach = 0;              ///< metres: photons within it of a surface enter its maps
  bool normals = false;         ///< normals of photons may disagree with those of hits
  /// What messages call a pair.
  std::function<std::string(std::uint32_t pair)> name_of;
};

/// Builds the maps of a plan. `store.map_of` is set, and with plan.normals `store.normals`, which
/// is empty afterwards where no map needs it.
///   spent   as for build_maps_of_groups
void build_maps(MapStore& store, const Photons& photons, Photons* spent, MapPlan plan,
                Progress& progress);

/// Builds one structure over all photons for hits of `map_count` maps; `store.normals` is set.
/// Errors: DeviceError when they do not fit in one buffer.
void build_global_map(MapStore& store, const Photons& photons, std::uint32_t map_count);

/// The radius that photons must lie within of a surface to enter its map, metres: grown by what
/// rounding may do to positions as large as the scene's, so that no neighbour is lost.
float reach_of(const Scene& scene, double radius);

/// Unit normals of sided triangles.
std::vector<glm::vec3> sided_normals(const Scene& scene);

}  // namespace photile::maps
