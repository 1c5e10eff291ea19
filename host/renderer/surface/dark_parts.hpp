// Parts of lit triangles that no photon reaches: under a box on a floor, behind a cabinet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/photons.hpp"
#include "photile/surface_index.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::surface {

/// Halves triangles, across the middles of their longest edges, as long as a half would hold 12
/// photons, were they as dense there as on the denser half of what it is a half of, and is not
/// smaller than a thousandth of the largest disc. A half on which next to none landed is a dark
/// part. In the order of the sided triangles.
///   photons   sorted by sided triangle; several processes find those of all together
///   dark      sides that are dark as a whole: have no parts
std::vector<DarkPart> find_dark_parts(const SurfaceMesh& mesh, const Photons& photons,
                                      std::span<const std::uint8_t> dark, double radius);

}  // namespace photile::surface
