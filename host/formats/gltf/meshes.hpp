// Triangles of glTF meshes, as the file has them and where nodes place them.
#pragma once

#include <string>
#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/materials.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"
#include "reading/triangles.hpp"
#include "scene/mesh_builder.hpp"

namespace photile::gltf {

/// Whether triangles can be made of it: of its mode, and positions that are not all 0, as those of
/// meshes that an extension compresses are. Errors: InputError for a wrong accessor number, naming
/// `use`.
bool is_usable(const tinygltf::Primitive& primitive, const std::string& use,
               const AccessorReader& accessors);

/// The accessor of an attribute, or -1.
int attribute(const tinygltf::Primitive& primitive, const std::string& name);

/// The name of a mesh in messages.
std::string name_of_mesh(const tinygltf::Model& model, int mesh);

/// All usable primitives of a mesh, in its own space. Errors: InputError.
reading::LocalMesh read_local_mesh(const tinygltf::Model& model, int mesh,
                                   const AccessorReader& accessors,
                                   const reading::ImportContext& context);

/// Adds the triangles of every visited node's mesh to the scene. Morph targets and skins stay in
/// their rest pose; points and lines are left out; both with a warning. Errors: InputError.
void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<MaterialCoordinates>& coordinates,
                     reading::ImportContext& context);

}  // namespace photile::gltf
