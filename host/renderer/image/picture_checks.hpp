// What a picture may ask for, and what is looked at before a decoder sees it.
#pragma once

#include <cstdint>
#include <string>

#include "image/decoder.hpp"
#include "photile/limits.hpp"

namespace photile::image {

/// Why a picture cannot be read whatever is done with it, or "".
std::string beyond_limits(int width, int height, std::size_t channels);

/// Why it cannot be held at once, or "".
///   bytes   of all its decoded values
std::string too_large(std::size_t channels, std::uint64_t bytes);

/// Decoded size is bounded before a pixel is decoded: a few bytes can announce terabytes.
///   encoded   bytes
/// Errors: DecodeError.
void check_shape(const PictureShape& shape, std::size_t encoded);

/// Of a picture that OpenImageIO is to open, what its reader would take memory for first, read as
/// another picture, or leave the memory for. Errors: DecodeError.
void check_encoded(PictureFormat format, Encoded bytes);

/// Decoded bytes that are not worth a check. Fuzzers take fewer: an input is to take microseconds.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::uint64_t unchecked_bytes = 1ull << 20;
#else
inline constexpr std::uint64_t unchecked_bytes = limits::unchecked_image_bytes;
#endif

}  // namespace photile::image
