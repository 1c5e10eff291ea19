// Pictures of radiance.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace photile::pictures {

struct RadiancePicture {
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;  ///< linear RGB, row 0 at the top; finite and not negative
};

/// Reads a picture in floating point (.hdr, .exr, .tif). Size and channels are checked against
/// limits.hpp before any pixel is decoded. Errors: InputError naming the file and, where texels are
/// NaN, infinite or negative, their number and the first of them.
RadiancePicture read_radiance_picture(const std::filesystem::path& file);

}  // namespace photile::pictures
