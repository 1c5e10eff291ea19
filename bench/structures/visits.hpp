// What a search looks at: counts that do not depend on the machine.
#pragma once

#include "photile/photon_maps.hpp"
#include "photile/ray_scene.hpp"

namespace photile::structures {

/// Means over hits.
struct Visits {
  double nodes = 0;    ///< of trees, or cells of a hashed grid
  double photons = 0;  ///< whose distance was computed
};

/// Counts by a kernel compiled for it. The maps are in a structure other than grids.
Visits count_visits(const PhotonMaps& maps, const PrimaryHits& hits, int k);

}  // namespace photile::structures
