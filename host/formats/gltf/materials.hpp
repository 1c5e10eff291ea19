// The materials and pictures of a glTF file become the scene's.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "files/scene_files.hpp"
#include "gltf/accessor.hpp"
#include "gltf/tiny_gltf.hpp"
#include "pictures/textures.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// An image whose colours RGBD may stretch: decode_rgbd. Errors: ResourceError.
pictures::RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t image,
                                       const AccessorReader& accessors, files::SceneFolder& folder);

/// Which texture coordinates a texture takes, and the affine map of KHR_texture_transform on them.
struct TextureCoordinates {
  int set = 0;  ///< n of TEXCOORD_n, as the file has it: the mesh need not have such a set
  glm::dmat2 linear{1.0};
  glm::dvec2 offset{0.0};

  glm::dvec2 operator()(const glm::dvec2& uv) const { return linear * uv + offset; }
  bool operator==(const TextureCoordinates& other) const = default;
};

/// The texture coordinates of a material's emission, and those that its other textures share.
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
