// EXRs of many lights: a part for the root, and one for each light.
#pragma once

#include <filesystem>

#include "photile/layered_picture.hpp"

namespace photile::image {

/// Writes the root as the first part, which has the picture's attributes, and each light as a part
/// that bears the name of its layer. No more than a few rows of all lights are in memory. Errors:
/// as write_exr.
void write_exr_parts(const std::filesystem::path& file, const LayeredPicture& picture,
                     const Image& root);

}  // namespace photile::image
