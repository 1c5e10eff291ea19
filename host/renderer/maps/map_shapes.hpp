// The boxes around the triangles that share photon maps, and how unevenly photons lie on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/device/map_shape.h"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

static_assert(sizeof(PhotileMapShape) == 25 * 4, "PhotileMapShape must have no padding");

/// The surfaces of pairs of maps.
struct MapShapes {
  /// Per pair. The u axis follows the longest edge of the largest triangle, so that the rectangle
  /// around a triangle is at most twice its area.
  std::vector<PhotileMapShape> shapes;
  std::vector<float> corners;  ///< 9 floats per triangle that is alone in its maps
};

/// The shapes of numbered pairs.
///   angle_radians   largest angle between normals of neighbours
MapShapes map_shapes(const Scene& scene, const Patches& patches,
                     std::span<const std::uint32_t> pairs, double angle_radians);

/// Per map: the density that its photons see around them, on average over the photons, as a
/// multiple of the mean density over the map's surface. 1 where photons are uniform or few. Cells
/// that are to hold some photons each where the photons are must be smaller by this factor than
/// cells that hold as many on average over the surface, a large part of which is empty.
///
/// It is found from counts n in bins of area A (small triangles, and parts of large ones): the sum
/// of n (n - 1) / A is an unbiased estimate of the integral of the squared density, for n (n - 1)
/// has the expectation (density x A)^2 when n is Poisson distributed.
std::vector<float> photon_density_ratio(const Scene& scene, const Photons& photons,
                                        const Patches& patches);

}  // namespace photile::maps
