// Drives the build kernels.
#pragma once

#include "maps/uniform_grid.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"

namespace photile::maps {

/// Builds the pages of `grid`, whose device, needs and parameters are set; fills its statistics.
void build_uniform_grid(UniformGrid& grid, const Scene& scene, const Photons& photons,
                        const NeighbourGroups& groups, Progress& progress);

}  // namespace photile::maps
