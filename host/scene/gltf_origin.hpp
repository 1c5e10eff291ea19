// Where the coordinates of a glTF scene are counted from.
#pragma once

#include <vector>

#include "scene/gltf_accessor.hpp"
#include "scene/gltf_nodes.hpp"
#include "scene/import_context.hpp"

namespace photile::scene_io {

/// Chooses Scene::origin (scene_origin.hpp) and moves the visited nodes there, with all that hangs
/// on them: meshes, cameras, lights. Reads every mesh once more. Errors: InputError.
void move_to_origin(const tinygltf::Model& model, const AccessorReader& accessors,
                    std::vector<NodeVisit>& visits, ImportContext& context);

}  // namespace photile::scene_io
