#include "pictures/texture_store.hpp"

#include <vector>

#include "scene/surface_models.hpp"

namespace photile::pictures {

std::uint32_t TextureStore::from_file(const std::string& name, TextureContent content) {
  const Key key(name, content);
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  return add(key, folder_.read(name));
}

std::uint32_t TextureStore::from_memory(const std::string& name,
                                        std::span<const unsigned char> bytes,
                                        TextureContent content) {
  const Key key(name, content);
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  return add(key, bytes);
}

std::uint32_t TextureStore::add(const Key& key, std::span<const unsigned char> bytes) {
  scene_.textures.push_back(decode_texture(key.first, bytes, key.second));
  const auto index = static_cast<std::uint32_t>(scene_.textures.size() - 1);
  index_.emplace(key, index);
  return index;
}

void use_missing_texture_colour(Material& material) {
  material.diffuse = glm::vec3(scene::missing_albedo);
  material.diffuse_texture = none;
}

}  // namespace photile::pictures
