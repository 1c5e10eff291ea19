// The pictures of a glTF file, wherever it keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "scene/gltf_accessor.hpp"
#include "scene/radiance_picture.hpp"
#include "scene/scene_folder.hpp"
#include "scene/texture_store.hpp"
#include "scene/tiny_gltf.hpp"

namespace photile::scene_io {

/// Index in Scene::textures of an image of the file. Errors: ResourceError where it cannot be read.
std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t image,
                              const AccessorReader& accessors, TextureContent content,
                              TextureStore& textures);

/// An image whose colours RGBD may stretch: decode_rgbd. Errors: ResourceError.
RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t image,
                             const AccessorReader& accessors, SceneFolder& folder);

}  // namespace photile::scene_io
