// The boxes around the triangles that share photon maps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/device/map_shape.h"
#include "photile/neighbour_groups.hpp"
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

}  // namespace photile::maps
