// The pictures of a glTF file, wherever it keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gltf/accessor.hpp"
#include "gltf/tiny_gltf.hpp"
#include "pictures/radiance_picture.hpp"
#include "files/scene_folder.hpp"
#include "pictures/texture_store.hpp"

namespace photile::scene_io {

/// Index in Scene::textures of an image of the file. Errors: ResourceError where it cannot be read.
std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t image,
                              const AccessorReader& accessors, TextureContent content,
                              TextureStore& textures);

/// An image whose colours RGBD may stretch: decode_rgbd. Errors: ResourceError.
RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t image,
                             const AccessorReader& accessors, SceneFolder& folder);

}  // namespace photile::scene_io
