// The sky of a live page, which follows the hour and the day.
#pragma once

#include "photile/load_scene.hpp"

namespace photile::view {

/// Where options give a site or a weather file, or ask for patches, and for no other sky or sun:
/// puts patches into the scene that is to be loaded, and returns the site and the time that move
/// them. Without a site they are one group of lights.
SkySituation take_moving_sky(SceneLoadOptions& options);

}  // namespace photile::view
