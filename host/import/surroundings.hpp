// Light from beyond the scene that the user adds: surroundings from a picture, a sun, a sky.
#pragma once

#include <string>

#include "photile/scene.hpp"

namespace photile::scene_io {

/// Adds a light that is a map of all that surrounds the scene, which must have its triangles.
void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene);

/// Adds the lights "environment", "sun" and "sky" that the options ask for; triangles must be
/// there. Errors: InputError for a picture that is missing, malformed, not in floating point, black
/// or has texels that are NaN, infinite or negative; UsageError for a clear sky without a sun above
/// the horizon.
void add_surroundings(Scene& scene, const SceneLoadOptions& options);

}  // namespace photile::scene_io
