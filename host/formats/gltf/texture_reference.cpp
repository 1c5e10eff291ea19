#include "gltf/texture_reference.hpp"

#include <cmath>

#include "gltf/document.hpp"

namespace photile::gltf {
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
