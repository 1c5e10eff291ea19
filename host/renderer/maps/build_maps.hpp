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

/// Builds one map per oriented face or side of a patch. Fills the pages and statistics of `store`,
/// whose device, needs and parameters are set.
///   consumed    the same photons where their arrays may be released on the way, else null
///   requested   as PhotonMaps has it
void build_maps_of_groups(MapStore& store, const Scene& scene, const Photons& photons,
                          Photons* consumed, const NeighbourGroups& groups,
                          std::span<const std::uint8_t> requested, Progress& progress);

/// The surfaces of maps, and the photons that may enter them.
struct MapPlan {
  CandidateMaps candidates;
  MapShapes surfaces;                ///< of pairs of maps
  std::vector<float> density_ratio;  ///< per map, see photon_density_ratio
  float reach = 0;                   ///< metres: photons within it of a surface enter its maps
  bool normals = false;              ///< normals of photons may disagree with those of hits
  /// The name of a pair in messages.
  std::function<std::string(std::uint32_t pair)> name_of;
};

/// Builds the maps of a plan. `store.map_of` is set, and with plan.normals `store.normals`, which
/// is empty afterwards where no map needs it.
///   consumed   as for build_maps_of_groups
void build_maps(MapStore& store, const Photons& photons, Photons* consumed, MapPlan plan,
                Progress& progress);

/// Adds a page whose maps are built to the store and its statistics.
void add_page(MapStore& store, MapPage page);

/// The distance from a surface within which photons enter its map, metres: enlarged by the possible
/// rounding of positions as large as the scene's, so that no neighbour is lost.
float reach_of(const Scene& scene, double radius);

/// Unit normals of oriented faces.
std::vector<glm::vec3> face_normals(const Scene& scene);

}  // namespace photile::maps
