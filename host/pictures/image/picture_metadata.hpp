// The metadata of picture files about their pixels: where these lie, and which light they
// represent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "image/color_space.hpp"
#include "image/decoder.hpp"

namespace photile::image {

/// How rows and columns are stored, by EXIF's numbers: the first row is the top (1, 2), the bottom
/// (3, 4), the left side (5, 8) or the right side (6, 7).
using Orientation = int;
inline constexpr Orientation upright = 1;
/// Whether stored rows are columns.
inline bool is_turned(Orientation orientation) { return orientation > 4; }

struct PictureMetadata {
  Orientation orientation = upright;
  ColorSpace color;
  glm::dvec3 scale{1.0};  ///< that real values are multiplied with before their colours are changed
  /// cd/m2 of the values (1, 1, 1); 0 where the file does not say it.
  double white_luminance = 0;
  /// What it is instead of an equirectangular map of all directions; "" where nothing is said.
  std::string projection;
};

/// Of a picture of any format but EXR, whose metadata ExrInput reads. Errors: DecodeError where
/// they are damaged, or place the pixels as no reader can.
///   reader   as reader_of
PictureMetadata read_metadata(std::string_view reader, Encoded bytes);

/// Where the entry of a tag begins in the first directory of a TIFF; nothing where it has none.
/// Errors: DecodeError where the file ends before the directory does.
std::optional<std::size_t> tiff_entry(Encoded tiff, std::uint32_t tag);

/// Of a Radiance picture (G. Ward, "Radiance File Formats"): what is before its pixels. A line that
/// begins with a blank belongs to a picture that this one was made of.
struct RadianceHeader {
  std::uint32_t rows = 0, columns = 0;  ///< as stored: a row is what is compressed together
  std::size_t end = 0;                  ///< where the pixels begin
  PictureMetadata metadata;
};
/// Errors: DecodeError.
RadianceHeader read_radiance_header(Encoded bytes);

}  // namespace photile::image
