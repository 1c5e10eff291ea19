#include "gltf/pictures.hpp"

#include <fmt/format.h>

#include <cmath>

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

namespace {

constexpr const char* transform_name = "KHR_texture_transform";

TextureCoordinates coordinates_of(int set, const tinygltf::Value* transform) {
  TextureCoordinates result;
  result.set = set;
  if (transform == nullptr) return result;
  const glm::dvec3 offset = vector_member(*transform, "offset", glm::dvec3(0.0));
  const glm::dvec3 scale = vector_member(*transform, "scale", glm::dvec3(1.0));
  const double angle = number_member(*transform, "rotation", 0.0);
  // Counter-clockwise as seen in the picture, whose v axis points down.
  const glm::dmat2 rotation(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
  result.linear = rotation * glm::dmat2(scale.x, 0.0, 0.0, scale.y);
  result.offset = {offset.x, offset.y};
  result.set = integer_member(*transform, "texCoord", result.set);
  return result;
}

template <class Info>
TextureReference reference(const Info& info) {
  return {info.index,
          coordinates_of(info.texCoord, find_extension(info.extensions, transform_name))};
}

}  // namespace

TextureReference reference_of(const tinygltf::TextureInfo& info) { return reference(info); }
TextureReference reference_of(const tinygltf::NormalTextureInfo& info) { return reference(info); }
TextureReference reference_of(const tinygltf::OcclusionTextureInfo& info) {
  return reference(info);
}

TextureReference reference_of(const tinygltf::Value& extension, const std::string& name) {
  if (!extension.Has(name) || !extension.Get(name).IsObject()) return {};
  const tinygltf::Value& info = extension.Get(name);
  const tinygltf::Value* transform = nullptr;
  if (info.Has("extensions") && info.Get("extensions").Has(transform_name)) {
    transform = &info.Get("extensions").Get(transform_name);
  }
  return {integer_member(info, "index", -1),
          coordinates_of(integer_member(info, "texCoord", 0), transform)};
}

}  // namespace photile::gltf
