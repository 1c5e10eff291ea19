// The limits of a picture, and checks before a decoder reads it, of EXR headers among others.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "image/decoder.hpp"
#include "photile/limits.hpp"

namespace photile::image {

enum class ByteOrder { little, big };

/// The number in `count` bytes. Errors: DecodeError where the file ends before them.
std::uint32_t number_at(Encoded bytes, std::size_t offset, std::size_t count,
                        ByteOrder order = ByteOrder::little);

/// Why a picture cannot be read whatever is done with it, or "".
std::string beyond_limits(int width, int height, std::size_t channels);

/// Why it cannot be held at once, or "".
///   bytes   of all its decoded values
std::string too_large(std::size_t channels, std::uint64_t bytes);

/// Decoded size is bounded before a pixel is decoded: a few bytes can announce terabytes.
///   encoded   bytes
/// Errors: DecodeError.
void check_shape(const PictureShape& shape, std::size_t encoded);

/// Refuses a picture for OpenImageIO for which its reader would reserve too much memory, which it
/// would read as another picture, or past whose bytes it would read. Errors: DecodeError.
///   reader   as reader_of
void check_encoded(std::string_view reader, Encoded bytes);

/// Decoded bytes that are not worth a check. Fuzzers take fewer: an input is to take microseconds.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::uint64_t unchecked_bytes = 1ull << 20;
#else
inline constexpr std::uint64_t unchecked_bytes = limits::unchecked_image_bytes;
#endif

/// OpenEXR reserves what an attribute and a table of the rows are said to take, and reads
/// attributes of types that it knows by their type, whatever their size says: its own limits would
/// hold for the whole process. Leaves the stream at its beginning. `bytes` are those of the file.
/// Errors: DecodeError where an attribute is not as large as its type or announces more than the
/// file holds, or the picture is larger than limits.hpp.
void check_exr_headers(Imf::IStream& stream, std::uint64_t bytes);

}  // namespace photile::image
