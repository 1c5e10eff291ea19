// Where the coordinates of a glTF scene are counted from.
#pragma once

#include <vector>

#include "import/gltf/accessor.hpp"
#include "import/gltf/nodes.hpp"
#include "import/import_context.hpp"

namespace photile::scene_io {

/// Chooses Scene::origin (scene_origin.hpp) and moves the visited nodes there, with all that hangs
/// on them: meshes, cameras, lights. Reads every mesh once more. Errors: InputError.
void move_to_origin(const tinygltf::Model& model, const AccessorReader& accessors,
                    std::vector<NodeVisit>& visits, ImportContext& context);

}  // namespace photile::scene_io
