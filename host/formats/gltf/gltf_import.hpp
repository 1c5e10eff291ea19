// A glTF file becomes a scene.
#pragma once

#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Refuses scenes of too many triangles, and those whose nodes and meshes repeat few bytes too
/// often (limits::max_triangle_expansion); nothing is read or allocated for that, and all is
/// counted in 64 bits. Errors: InputError naming the mesh that asks for most.
void check_scene_size(const tinygltf::Model& model, const AccessorReader& accessors,
                      const std::vector<NodeVisit>& visits, const reading::ImportContext& context);

/// Fills the context's scene from its .gltf or .glb file. Errors: InputError.
void import_gltf(reading::ImportContext& context);

}  // namespace photile::gltf
