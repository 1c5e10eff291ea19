// glTF materials to photile's.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf_accessor.hpp"
#include "scene/import_context.hpp"
#include "scene/tiny_gltf.hpp"

namespace photile::scene_io {

/// Which texture coordinates a texture takes, and the affine map of
/// KHR_texture_transform on them.
struct TextureCoordinates {
  int set = 0;
  glm::dmat2 linear{1.0};
  glm::dvec2 offset{0.0};

  glm::dvec2 operator()(const glm::dvec2& uv) const { return linear * uv + offset; }
  bool operator==(const TextureCoordinates& other) const = default;
};

/// Those of a material's emission, and those that its other textures share.
struct MaterialCoordinates {
  TextureCoordinates surface, emission;
};

/// Converts all materials, in the order of the file, and appends glTF's default material where some
/// primitive has none. What photile approximates is named in a warning. Returns the texture
/// coordinates of each material.
std::vector<MaterialCoordinates> add_gltf_materials(const tinygltf::Model& model,
                                                    const AccessorReader& accessors,
                                                    ImportContext& context);

}  // namespace photile::scene_io
