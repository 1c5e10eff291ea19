// Groups of lights that the user asks for.
#pragma once

#include <span>

#include "photile/scene.hpp"

namespace photile::scene_io {

/// Sets Light::group of the lights that each grouping matches, one grouping after the other. Names
/// of lights must be final. Errors: UsageError when one matches no light (the message lists those
/// there are), or when a group bears the name of a light outside it.
void group_lights(Scene& scene, std::span<const LightGrouping> groupings);

}  // namespace photile::scene_io
