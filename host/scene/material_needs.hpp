// What materials ask of a mesh, known before there are triangles.
#pragma once

#include <span>

#include "photile/scene_needs.hpp"

namespace photile::scene_io {

/// What any of these materials asks for, whether or not a triangle has it: importers must choose
/// what to read of a mesh before the first triangle. light_count stays 0.
SceneNeeds needs_of_materials(std::span<const Material> materials);

}  // namespace photile::scene_io
