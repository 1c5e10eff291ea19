// A decoder for each format, each from the library that the format's users keep, or a few lines
// where the format is that simple. All are loaded in milliseconds.
#pragma once

#include <span>

#include "image/decoder.hpp"

namespace photile::image {

using Encoded = std::span<const unsigned char>;

std::unique_ptr<Decoder> open_exr(Encoded bytes);       ///< OpenEXR
std::unique_ptr<Decoder> open_png(Encoded bytes);       ///< libpng
std::unique_ptr<Decoder> open_jpeg(Encoded bytes);      ///< libjpeg
std::unique_ptr<Decoder> open_tiff(Encoded bytes);      ///< libtiff
std::unique_ptr<Decoder> open_webp(Encoded bytes);      ///< libwebp
std::unique_ptr<Decoder> open_simple(Encoded bytes);    ///< stb_image: BMP, GIF, Targa
std::unique_ptr<Decoder> open_radiance(Encoded bytes);  ///< .hdr
std::unique_ptr<Decoder> open_pnm(Encoded bytes);       ///< P1 to P6

}  // namespace photile::image
