// PNGs of 8-bit sRGB.
#pragma once

#include <cstdint>
#include <span>

#include "common/output_file.hpp"

namespace photile::image {

/// Encodes rows x width x channels texels (3: RGB, 4: RGB and an alpha that colours are not
/// multiplied with) and writes them to a file that the caller commits.
/// Errors: those of OutputFile::fail.
void encode_png(OutputFile& output, int width, int height, std::span<const std::uint8_t> texels);

}  // namespace photile::image
