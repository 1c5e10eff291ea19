// Lights without size that lie in a surface.
#pragma once

#include "photile/scene.hpp"

namespace photile::trace {

/// Moves point and spot lights that lie in a surface, to the rounding of coordinates, off it to one
/// side, far enough that photons from the light and shadow rays to it agree on its side, which
/// rounding would otherwise decide. It is the side to which the light shines. A light that shines
/// to both sides lies below the surface, or, where nothing else lies below or the surface is
/// upright, on the side of the middle of the scene.
void offset_lights(Scene& scene);

}  // namespace photile::trace
