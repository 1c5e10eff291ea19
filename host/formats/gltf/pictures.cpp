#include "gltf/pictures.hpp"

#include <fmt/format.h>

#include "gltf/document.hpp"
#include "pictures/texture_decoder.hpp"

namespace photile::gltf {
namespace {

/// What tells the picture from others, and messages call it.
std::string name_of(const tinygltf::Image& image, std::size_t number) {
  return fmt::format("image {}{}", number, image.name.empty() ? "" : " " + image.name);
}

}  // namespace

std::uint32_t texture_picture(const tinygltf::Model& model, std::size_t number,
                              const AccessorReader& accessors, pictures::TextureContent content,
                              pictures::TextureStore& textures) {
  const tinygltf::Image& image = model.images[number];
  const std::string name = name_of(image, number);
  if (image.bufferView >= 0) {
    return textures.from_memory(name, accessors.view(image.bufferView, name), content);
  }
  if (!image.image.empty()) return textures.from_memory(name, image.image, content);
  return textures.from_file(decoded_uri(image.uri), content);
}

pictures::RadiancePicture rgbd_picture(const tinygltf::Model& model, std::size_t number,
                                       const AccessorReader& accessors,
                                       files::SceneFolder& folder) {
  const tinygltf::Image& image = model.images[number];
  const std::string name = name_of(image, number);
  if (image.bufferView >= 0)
    return pictures::decode_rgbd(name, accessors.view(image.bufferView, name));
  if (!image.image.empty()) return pictures::decode_rgbd(name, image.image);
  const std::string file = decoded_uri(image.uri);
  return pictures::decode_rgbd(file, folder.read(file));
}

}  // namespace photile::gltf
