// What a scene gets once its file has been read: groups of lights, surroundings, a camera.
#pragma once

#include <span>
#include <string>

#include "photile/scene.hpp"

namespace photile::scene_io {

/// Sets Light::group of the lights that each grouping matches, one grouping after the other. Names
/// of lights must be final. Errors: UsageError when one matches no light (the message lists those
/// there are), or when a group bears the name of a light outside it.
void group_lights(Scene& scene, std::span<const LightGrouping> groupings);

/// Adds a light that is a map of all that surrounds the scene, which must have its triangles.
void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene);

/// Adds the lights "environment", "sun" and "sky" that the options ask for; triangles must be
/// there. Errors: InputError for a picture that is missing, malformed, not in floating point, black
/// or has texels that are NaN, infinite or negative; UsageError for a clear sky without a sun above
/// the horizon.
void add_surroundings(Scene& scene, const SceneLoadOptions& options);

/// A camera that shows the scene, y upwards. A side of the bounding box counts as open when less
/// than half of it is covered by triangles in its plane.
/// - A room with an open side (a Cornell box) is framed through that side from outside.
/// - A closed room is seen from the inside: from the corner with most free space, towards the
///   opposite one.
/// - Anything else is framed from the front, the right and above.
/// `scene` has at least one triangle.
Camera place_camera(const Scene& scene);

}  // namespace photile::scene_io
