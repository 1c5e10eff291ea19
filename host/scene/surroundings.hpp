// Light from beyond the scene that the user adds: surroundings from a picture, a sun, a sky.
#pragma once

#include "photile/scene.hpp"

namespace photile::scene_io {

/// Adds the lights "environment", "sun" and "sky" that the options ask for; triangles must be
/// there. Errors: InputError for a picture that is missing, malformed, not in floating point, black
/// or has texels that are NaN, infinite or negative; UsageError for a clear sky without a sun above
/// the horizon.
void add_surroundings(Scene& scene, const SceneLoadOptions& options);

}  // namespace photile::scene_io
