// What a search looks at: counts that do not depend on the machine.
#pragma once

#include "photile/photon_maps.hpp"
#include "photile/ray_scene.hpp"

namespace photile::bench {

/// Means over hits.
struct Visits {
  double nodes = 0;    ///< of trees, or cells of a hashed grid
  double photons = 0;  ///< whose distance was computed
};

/// Counts by a kernel compiled for it. The structure of the maps must be searched by
/// kernels/structures: counts_visits.
Visits count_visits(const PhotonMaps& maps, const PrimaryHits& hits, int k);

/// Whether the searches of a structure are counted: not those of uniform grids and brute force.
bool counts_visits(MapStructure structure);

}  // namespace photile::bench
