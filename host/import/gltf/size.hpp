// How much a glTF file asks for, before any of it is read.
#pragma once

#include <vector>

#include "import/gltf/accessor.hpp"
#include "import/gltf/nodes.hpp"
#include "import/import_context.hpp"

namespace photile::scene_io {

/// Refuses scenes of too many triangles, and those whose nodes and meshes repeat few bytes too
/// often (limits::max_repeated_triangles); nothing is read or allocated for that, and all is
/// counted in 64 bits. Errors: InputError naming the mesh that asks for most.
void check_scene_size(const tinygltf::Model& model, const AccessorReader& accessors,
                      const std::vector<NodeVisit>& visits, const ImportContext& context);

}  // namespace photile::scene_io
