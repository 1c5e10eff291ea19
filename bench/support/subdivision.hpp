// Finer meshes of the same surfaces.
#pragma once

#include "photile/scene.hpp"

namespace photile::bench {

/// Every triangle cut into four at the middles of its edges. Materials, lights, sides and textures
/// stay where they were; shading normals and shared meshes are left out.
Scene subdivided(const Scene& scene);

}  // namespace photile::bench
