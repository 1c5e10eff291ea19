// What materials ask of a mesh, known before there are triangles.
#pragma once

#include <span>

#include "photile/scene.hpp"
#include "photile/scene_needs.hpp"

namespace photile::scene {

/// What any of these materials asks for, whether or not a triangle has it: importers must choose
/// what to read of a mesh before the first triangle. light_count stays 0.
SceneNeeds needs_of_materials(std::span<const Material> materials);

/// Lets go of shading normals where none is asked for: all are those of their triangles, or lie on
/// what scatters no light, and no material that the needs tell of is specular or glossy.
void drop_flat_normals(Scene& scene, const SceneNeeds& of_materials);

}  // namespace photile::scene
