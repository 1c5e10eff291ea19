// A camera for files without one.
#pragma once

#include "photile/scene.hpp"

namespace photile::trace {

/// A camera that shows the scene, y upwards. A side of the bounding box counts as open when less
/// than half of it is covered by triangles in its plane.
/// - A room with an open side (a Cornell box) is framed through that side from outside.
/// - A building is seen from within its largest room, at eye height: from near the end
///   from which most of it is visible. A room has walls, or glass, around most of it, and a
///   ceiling; the inside of a solid is not a room.
/// - Anything else is framed from the front, the right and above.
/// `scene` has at least one triangle.
Camera place_camera(const Scene& scene);

}  // namespace photile::trace
