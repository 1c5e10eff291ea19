// Lights without size that lie in a surface.
#pragma once

#include "photile/scene.hpp"

namespace photile::trace {

/// Moves point and spot lights that lie in a surface, to the rounding of coordinates, off it to one
/// side: by so much that photons from the light and shadow rays to it agree on which side
/// it is, which roundings would decide otherwise. The side is the one to which the light shines.
/// One that shines to both lies below the surface, or, where nothing else lies below or the surface
/// is upright, on the side of the middle of the scene.
void offset_lights(Scene& scene);

}  // namespace photile::trace
