// Which scene something was computed from.
#pragma once

#include "common/content_hash.hpp"
#include "photile/scene.hpp"

namespace photile::scene {

/// Adds everything that light depends on: geometry, materials, texels, lights with their groups,
/// and the unit; not cameras and names of files.
void add_scene(const Scene& scene, ContentHash& hash);

}  // namespace photile::scene
