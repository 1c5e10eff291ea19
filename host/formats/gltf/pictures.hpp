// The pictures of a glTF file, wherever it keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "files/scene_folder.hpp"
#include "gltf/accessor.hpp"
#include "gltf/tiny_gltf.hpp"
#include "pictures/radiance_picture.hpp"
#include "pictures/texture_store.hpp"

namespace photile::gltf {

/// Index in Scene::textures of an image of the file. Errors: ResourceError where it cannot be read.
std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t image,
                              const AccessorReader& accessors, pictures::TextureContent content,
                              pictures::TextureStore& textures);

/// An image whose colours RGBD may stretch: decode_rgbd. Errors: ResourceError.
pictures::RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t image,
                                       const AccessorReader& accessors, files::SceneFolder& folder);

}  // namespace photile::gltf
