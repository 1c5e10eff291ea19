// The boxes around the triangles that share photon maps.
#pragma once

#include <vector>

#include "photile/device/map_shape.h"
#include "photile/patches.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

static_assert(sizeof(PhotileMapShape) == 19 * 4, "PhotileMapShape must have no padding");

/// Shape i is that of maps 2 i and 2 i + 1: a triangle's, or a patch's. The u axis follows the longest
/// edge of the largest triangle, so that the rectangle around a triangle is at most twice its area.
///   angle_radians   largest angle between normals of neighbours
std::vector<PhotileMapShape> map_shapes(const Scene& scene, const Patches& patches,
                                        double angle_radians);

}  // namespace photile::maps
