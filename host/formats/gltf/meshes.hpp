// Triangles of glTF meshes.
#pragma once

#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/materials.hpp"
#include "gltf/nodes.hpp"
#include "reading/import_context.hpp"
#include "scene/mesh_builder.hpp"

namespace photile::gltf {

/// Adds the triangles of every visited node's mesh to the scene. Morph targets and skins stay in
/// their rest pose; points and lines are left out; both with a warning. Errors: InputError.
void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<MaterialCoordinates>& coordinates,
                     reading::ImportContext& context);

}  // namespace photile::gltf
