// The textures of a scene, each decoded once.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "files/scene_folder.hpp"
#include "photile/scene.hpp"
#include "pictures/texture_decoder.hpp"

namespace photile::pictures {

class TextureStore {
 public:
  TextureStore(Scene& scene, files::SceneFolder& folder) : scene_(scene), folder_(folder) {}

  /// Index in Scene::textures of a picture file named by the scene. Errors: ResourceError.
  std::uint32_t from_file(const std::string& name, TextureContent content = TextureContent::color);

  /// The same for a picture inside the scene file; `name` tells it from others. Errors:
  /// ResourceError.
  std::uint32_t from_memory(const std::string& name, std::span<const unsigned char> bytes,
                            TextureContent content = TextureContent::color);

 private:
  using Key = std::pair<std::string, TextureContent>;
  std::uint32_t add(const Key& key, std::span<const unsigned char> bytes);

  Scene& scene_;
  files::SceneFolder& folder_;
  std::map<Key, std::uint32_t> index_;
};

/// Makes the lack of a texture visible but harmless: a mid-grey Lambertian part.
void use_missing_texture_colour(Material& material);

}  // namespace photile::pictures
