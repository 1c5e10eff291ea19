// What a scene gets once its file has been read: groups of lights, surroundings.
#pragma once

#include <span>

#include "photile/scene.hpp"

namespace photile::loading {

/// Sets Light::group of the lights that each grouping matches, one grouping after the other. Names
/// of lights must be final. Errors: UsageError when one matches no light (the message lists those
/// there are), or when a group bears the name of a light outside it.
void group_lights(Scene& scene, std::span<const LightGrouping> groupings);

/// Adds the lights "environment", "sun" and "sky" that the options ask for; triangles must be
/// there. Errors: InputError for a picture that is missing, malformed, not in floating point, black
/// or has texels that are NaN, infinite or negative; UsageError for a clear sky without a sun above
/// the horizon.
void add_surroundings(Scene& scene, const SceneLoadOptions& options);

}  // namespace photile::loading
