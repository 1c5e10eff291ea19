// The points of the surface at which nodes are valued.
#pragma once

#include <span>

#include "light_maps/charts.hpp"
#include "photile/primary_hits.hpp"

namespace photile::light_maps {

/// Point i is that which owns node i, seen from straight above, matt.
///   glossy   whether hits of the scene have lobes
PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                        int levels, bool glossy);

}  // namespace photile::light_maps
