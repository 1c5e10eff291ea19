// The pictures of a glTF file, wherever it keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "import/gltf/accessor.hpp"
#include "import/gltf/tiny_gltf.hpp"
#include "import/radiance_picture.hpp"
#include "import/scene_folder.hpp"
#include "import/texture_store.hpp"

namespace photile::scene_io {

/// Index in Scene::textures of an image of the file. Errors: ResourceError where it cannot be read.
std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t image,
                              const AccessorReader& accessors, TextureContent content,
                              TextureStore& textures);

/// An image whose colours RGBD may stretch: decode_rgbd. Errors: ResourceError.
RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t image,
                             const AccessorReader& accessors, SceneFolder& folder);

}  // namespace photile::scene_io
