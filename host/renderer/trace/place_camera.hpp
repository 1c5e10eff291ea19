// A camera for files that have none.
#pragma once

#include "photile/scene.hpp"

namespace photile::trace {

/// A camera that shows the scene, y upwards. A side of the bounding box counts as open when less
/// than half of it is covered by triangles in its plane.
/// - A room with an open side (a Cornell box) is framed through that side from outside.
/// - A closed room is seen from the inside: from the corner with most free space, towards the
///   opposite one.
/// - Anything else is framed from the front, the right and above.
/// `scene` has at least one triangle.
Camera place_camera(const Scene& scene);

}  // namespace photile::trace
