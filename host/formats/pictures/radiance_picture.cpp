#include "pictures/radiance_picture.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "files/scene_folder.hpp"
#include "files/warnings.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "pictures/texture_decoder.hpp"

namespace photile::pictures {
namespace {

bool is_radiance(const glm::vec3& texel) {
  const auto valid = [](float value) { return std::isfinite(value) && value >= 0.0f; };
  return valid(texel.r) && valid(texel.g) && valid(texel.b);
}

void check_texels(const RadiancePicture& picture) {
  std::size_t wrong = 0, first = 0;
  for (std::size_t i = picture.texels.size(); i-- > 0;) {
    if (is_radiance(picture.texels[i])) continue;
    ++wrong;
    first = i;
  }
  if (wrong == 0) return;
  const auto width = static_cast<std::size_t>(picture.width);
  const glm::vec3& texel = picture.texels[first];
  throw files::ResourceError(fmt::format(
      "{} of {} texels are NaN, infinite or negative, the first at column {}, row {}: ({}, {}, {})",
      wrong, picture.texels.size(), first % width, first / width, texel.r, texel.g, texel.b));
}

}  // namespace

RadiancePicture read_radiance_picture(const std::filesystem::path& file) {
  try {
    const std::vector<unsigned char> bytes =
        files::read_regular_file(file, limits::max_external_bytes);
    RadiancePicture picture = decode_radiance(file.string(), bytes);
    check_texels(picture);
    return picture;
  } catch (const files::ResourceError& error) {
    throw InputError(
        fmt::format("{}: cannot use the environment: {}; give an equirectangular .hdr or .exr",
                    file.string(), error.what()));
  }
}

}  // namespace photile::pictures
