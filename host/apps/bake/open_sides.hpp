// Which surface anybody can see, or light can reach: the insides of closed things need no light
// maps.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/ray_scene.hpp"

namespace photile::bake {

/// Per oriented face 1 where paths from the cameras and the lights come to it, or to its sheet:
/// what goes on over common edges. Else 0. Paths leave surfaces by the cosine and go on through
/// glass and cutouts, too. Depends on the scene alone.
std::vector<std::uint8_t> open_sides(const RayScene& rays);

}  // namespace photile::bake
