// Pictures of a scene, decoded: textures, and surroundings on the six faces of a cube.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/content_hash.hpp"
#include "files/scene_files.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"

namespace photile::pictures {

/// A picture of radiance.
struct RadiancePicture {
  int width = 0, height = 0;
  /// Texels are cd/m2, since the picture says so; else their unit is whatever its reader takes.
  bool in_candela = false;
  std::vector<glm::vec3> texels;  ///< linear RGB, row 0 at the top; finite and not negative
};

/// Reads an equirectangular picture in floating point (.hdr, .exr, .tif). Size and channels are
/// checked against limits.hpp before any pixel is decoded. Errors: InputError naming the file and,
/// where texels are NaN, infinite or negative, their number and the first of them; also where the
/// picture says that it is of another projection.
RadiancePicture read_radiance_picture(const std::filesystem::path& file);

/// What the channels of a texture mean.
enum class TextureContent {
  color,   ///< colours and alpha
  srgb,    ///< the same, in sRGB whatever the picture says of its colours
  data,    ///< normals or factors
  opacity  ///< alpha, or the first channel of a picture that has none
};

/// Decodes an encoded picture. Size and channels are checked against limits.hpp before any pixel is
/// decoded. Linear pictures (EXR, HDR) are clamped to [0,1]; colours are encoded as 8-bit sRGB of
/// Rec.709, all else as it is. `name` names the texture and, by its extension, formats that have no
/// signature. Errors: ResourceError naming the picture and the reason.
///   most_bytes   that its texels may take
Texture decode_texture(const std::string& name, std::span<const unsigned char> bytes,
                       TextureContent content = TextureContent::color,
                       std::uint64_t most_bytes = limits::max_image_bytes);

/// Decodes a picture in floating point without clamping; grey ones have equal channels.
/// Errors: ResourceError with the reason, also for a picture of integers.
RadiancePicture decode_radiance(const std::string& name, std::span<const unsigned char> bytes);

/// Decodes a picture in sRGB to linear values; where it has an alpha channel, values up to 255
/// packed as RGBD: colour / alpha, an alpha of 0 counting as the least there is. Errors:
/// ResourceError naming the picture and the reason.
RadiancePicture decode_rgbd(const std::string& name, std::span<const unsigned char> bytes);

/// The textures of a scene, each decoded once under whatever names.
class TextureStore {
 public:
  TextureStore(Scene& scene, files::SceneFolder& folder) : scene_(scene), folder_(folder) {}

  /// Index in Scene::textures of a picture file named by the scene. Errors: ResourceError.
  std::uint32_t from_file(const std::string& name, TextureContent content = TextureContent::color);

  /// Index in Scene::textures of a picture inside the scene file; `name` tells it from others.
  /// Errors: ResourceError.
  std::uint32_t from_memory(const std::string& name, std::span<const unsigned char> bytes,
                            TextureContent content = TextureContent::color);

 private:
  using Key = std::pair<std::string, TextureContent>;
  std::uint32_t add(const Key& key, std::span<const unsigned char> bytes);

  Scene& scene_;
  files::SceneFolder& folder_;
  std::map<Key, std::uint32_t> index_;
  std::map<ContentHash::Digest, std::uint32_t> of_content_;
  std::uint64_t encoded_bytes_ = 0, decoded_bytes_ = 0;
};

/// Makes the lack of a texture visible but harmless: a mid-grey Lambertian part.
void use_missing_texture_colour(Material& material);

/// Faces +x, -x, +y, -y, +z, -z, each as an observer in the middle sees it: with +y at the top; of
/// +y -z at the top, and of -y +z. All are square and of one size, of a texel at least.
using CubeMap = std::array<RadiancePicture, 6>;

/// Texel of a unit direction.
const glm::vec3& radiance_towards(const CubeMap& cube, const glm::dvec3& direction);

/// The cube, turned by `rotation`, as an equirectangular map of about the same resolution: each
/// texel is the mean over its solid angle, by 4 x 4 samples.
EnvironmentMap environment_of(const CubeMap& cube, const glm::dquat& rotation, std::string name);

}  // namespace photile::pictures
