// glTF materials to photile's.
#pragma once

#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/pictures.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Those of a material's emission, and those that its other textures share.
struct MaterialCoordinates {
  TextureCoordinates surface, emission;
};

/// Converts all materials, in the order of the file, and appends glTF's default material where some
/// primitive has none. What photile approximates is named in a warning. Returns the texture
/// coordinates of each material.
std::vector<MaterialCoordinates> add_gltf_materials(const tinygltf::Model& model,
                                                    const AccessorReader& accessors,
                                                    reading::ImportContext& context);

}  // namespace photile::gltf
