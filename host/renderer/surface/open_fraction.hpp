// The fraction of a triangle that is open to light, and not covered by what lies on it, like the
// wall behind tiles or the desk under a book.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/coplanar_regions.hpp"
#include "surface/smooth_components.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::surface {

/// Per oriented face: the fraction of its points above which, within a fifth of the radius, no
/// surface faces it on which no photon landed. 1 where that is half of them or more: surface that
/// is covered only in places counts as open, so that estimates are correct where it is open.
///   lit   per component
std::vector<float> find_open_fractions(const SurfaceMesh& mesh, const CoplanarRegions& regions,
                                       const SmoothComponents& components,
                                       const std::vector<std::uint8_t>& lit, double radius,
                                       double angle_degrees);

}  // namespace photile::surface
