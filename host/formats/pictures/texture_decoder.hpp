// Pictures of a scene, decoded.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile::pictures {

/// A picture of radiance, whatever its unit.
struct RadiancePicture {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;  ///< linear RGB, row 0 at the top; finite and not negative
};

/// Reads a picture in floating point (.hdr, .exr, .tif). Size and channels are checked against
/// limits.hpp before any pixel is decoded. Errors: InputError naming the file and, where texels are
/// NaN, infinite or negative, their number and the first of them.
RadiancePicture read_radiance_picture(const std::filesystem::path& file);

/// What the channels of a texture mean.
enum class TextureContent {
  color,   ///< colours and alpha
  data,    ///< normals or factors
  opacity  ///< alpha, or the first channel of a picture that has none
};

/// Decodes an encoded picture. Size and channels are checked against limits.hpp before any pixel is
/// decoded. Linear pictures (EXR, HDR) are clamped to [0,1]; colours are encoded as 8-bit sRGB, all
/// else as it is. `name` names the texture and, by its extension, formats that have no signature.
/// Errors: ResourceError naming the picture and the reason.
Texture decode_texture(const std::string& name, std::span<const unsigned char> bytes,
                       TextureContent content = TextureContent::color);

/// Decodes a picture in floating point without clamping; grey ones have equal channels.
/// Errors: ResourceError with the reason, also for a picture of integers.
RadiancePicture decode_radiance(const std::string& name, std::span<const unsigned char> bytes);

/// Decodes a picture in sRGB to linear values; where it has an alpha channel, values up to 255
/// packed as RGBD: colour / alpha, an alpha of 0 counting as the least there is. Errors:
/// ResourceError naming the picture and the reason.
RadiancePicture decode_rgbd(const std::string& name, std::span<const unsigned char> bytes);

}  // namespace photile::pictures
