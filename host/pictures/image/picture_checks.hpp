// The limits of a picture, and checks before a decoder reads it, of EXR headers among others.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfIO.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

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
/// Returns where the headers end.
/// Errors: DecodeError where an attribute is not as large as it has to be, announces more than the
/// file holds, or the picture is larger than limits.hpp.
std::uint64_t check_exr_headers(Imf::IStream& stream, std::uint64_t bytes);

/// Bytes of the tables of a file and of the blocks of pixels that they point at, compressed as they
/// are: without attributes, and without what lies between and behind the blocks. Leaves the stream
/// where it was.
///   table     where the tables begin, as check_exr_headers returns it
///   bytes     those of the file
///   entries   of the tables: one a block, of all parts
///   tiled     whether a part has tiles in place of rows, per part
/// Errors: DecodeError where a block is not within the file, or the tables have more entries.
std::uint64_t exr_pixel_bytes(Imf::IStream& stream, std::uint64_t table, std::uint64_t bytes,
                              std::uint64_t entries, const std::vector<bool>& tiled);

/// A block of pixels, as the header of its part has it.
struct ExrBlock {
  std::uint64_t entry = 0;  ///< in the tables of all parts
  std::uint64_t bytes = 0;  ///< decoded
  Imf::Compression compression = Imf::NO_COMPRESSION;
};

/// Refuses a block that decodes to fewer bytes than its pixels take: for the others OpenEXR takes
/// what is in its memory. Other compressions than none, RLE and ZIP it checks itself. Leaves the
/// stream where it was. To be called after exr_pixel_bytes. Errors: DecodeError.
void check_exr_block(Imf::IStream& stream, std::uint64_t table, const ExrBlock& block, bool tiled);

}  // namespace photile::image
