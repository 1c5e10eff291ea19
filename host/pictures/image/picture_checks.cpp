#include "image/picture_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "image/decoder.hpp"
#include "image/picture_metadata.hpp"
#include "photile/limits.hpp"

namespace photile::image {

std::uint32_t number_at(Encoded bytes, std::size_t offset, std::size_t count, ByteOrder order) {
  if (offset > bytes.size() || count > bytes.size() - offset) {
    throw DecodeError("the file ends too early");
  }
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | bytes[offset + (order == ByteOrder::big ? i : count - 1 - i)];
  }
  return value;
}

namespace {

/// The reader takes memory for the whole picture when it opens one.
void check_canvas(std::uint32_t width, std::uint32_t height, Encoded bytes) {
  check_shape({static_cast<int>(width), static_cast<int>(height), 4, Sample::byte}, bytes.size());
}

void check_gif(Encoded bytes) {
  check_canvas(number_at(bytes, 6, 2), number_at(bytes, 8, 2), bytes);
}

void check_webp(Encoded bytes) {
  constexpr std::uint32_t most = 0x3FFF;
  switch (number_at(bytes, 12, 4, ByteOrder::big)) {
    case 0x56503820:  // "VP8 "
      return check_canvas(number_at(bytes, 26, 2) & most, number_at(bytes, 28, 2) & most, bytes);
    case 0x5650384C: {  // "VP8L"
      const std::uint32_t size = number_at(bytes, 21, 4);
      return check_canvas(1 + (size & most), 1 + (size >> 14 & most), bytes);
    }
    case 0x56503858:  // "VP8X"
      return check_canvas(1 + number_at(bytes, 24, 3), 1 + number_at(bytes, 27, 3), bytes);
    default:
      throw DecodeError("the header is damaged");
  }
}

/// The reader has no number of channels for other depths.
void check_bmp(Encoded bytes) {
  const bool os2 = number_at(bytes, 14, 4) == 12;
  const std::uint32_t bits = number_at(bytes, os2 ? 24 : 28, 2);
  constexpr std::uint32_t known[] = {1, 4, 8, 16, 24, 32};
  if (std::find(std::begin(known), std::end(known), bits) == std::end(known)) {
    throw DecodeError(fmt::format("{} bits a pixel are not read", bits));
  }
}

/// The reader looks texels up in the palette without checking its size.
void check_targa(Encoded bytes) {
  const bool palette = number_at(bytes, 2, 1) == 1 || number_at(bytes, 2, 1) == 9;
  const std::uint32_t first = number_at(bytes, 3, 2), colours = number_at(bytes, 5, 2),
                      bits = number_at(bytes, 16, 1);
  if (palette && (bits != 8 || first != 0 || colours < 256)) {
    throw DecodeError("a palette of other than 256 colours is not read; save it in true colour");
  }
}

/// Without the tag the format has one bit a sample, and the reader takes eight.
void check_tiff(Encoded bytes) {
  constexpr std::uint32_t bits_per_sample = 258;
  if (tiff_entry(bytes, bits_per_sample)) return;
  throw DecodeError("the number of bits per sample is missing; save it with 8");
}

}  // namespace

std::string beyond_limits(int width, int height, std::size_t channels) {
  if (width < 1 || height < 1 || channels < 1) {
    return fmt::format("is {} x {} pixels with {} channels; pixels are needed", width, height,
                       channels);
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * height;
  if (width > limits::max_image_side || height > limits::max_image_side ||
      pixels > limits::max_image_pixels) {
    return fmt::format(
        "is {} x {} pixels, more than the limit of {} a side or {} in all; scale it down", width,
        height, limits::max_image_side, limits::max_image_pixels);
  }
  return {};
}

std::string too_large(std::size_t channels, std::uint64_t bytes) {
  if (channels <= limits::max_image_channels && bytes <= limits::max_image_bytes) return {};
  return fmt::format(
      "has {} channels ({} bytes decoded), more than the limit of {} ({}); "
      "leave channels out or scale it down",
      channels, bytes, limits::max_image_channels, limits::max_image_bytes);
}

void check_shape(const PictureShape& shape, std::size_t encoded) {
  const auto channels = static_cast<std::size_t>(std::max(shape.channels, 0));
  std::string reason = beyond_limits(shape.width, shape.height, channels);
  if (reason.empty()) reason = too_large(channels, shape.bytes());
  if (!reason.empty()) throw DecodeError(reason);
  if (shape.bytes() > unchecked_bytes &&
      shape.bytes() / std::max<std::size_t>(encoded, 1) > limits::max_image_expansion) {
    throw DecodeError(
        fmt::format("is damaged or empty: {} bytes decode to {}; the limit is a factor of {}",
                    encoded, shape.bytes(), limits::max_image_expansion));
  }
}

void check_encoded(std::string_view reader, Encoded bytes) {
  using Check = void (*)(Encoded);
  constexpr std::array<std::pair<std::string_view, Check>, 5> checks{{{"gif", check_gif},
                                                                      {"webp", check_webp},
                                                                      {"bmp", check_bmp},
                                                                      {"targa", check_targa},
                                                                      {"tiff", check_tiff}}};
  for (const auto& [name, check] : checks) {
    if (name == reader) check(bytes);
  }
}

namespace {

std::uint32_t little_endian(Imf::IStream& stream) {
  char text[4] = {};
  stream.read(text, sizeof text);
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(text[i]);
  return value;
}

/// A name, of at most 255 letters.
std::string word_in(Imf::IStream& stream) {
  std::string text;
  for (char letter = 0; text.size() < 256; text += letter) {
    stream.read(&letter, 1);
    if (letter == '\0') return text;
  }
  throw DecodeError("the header is damaged");
}

/// Bytes of the types that have a fixed size (OpenEXR, "File Layout", predefined
/// attributes); 0 of others.
std::uint32_t size_of(const std::string& type) {
  static constexpr std::string_view sizes =
      " box2f 16 box2i 16 chromaticities 32 compression 1 deepImageState 1 double 8 envmap 1 float "
      "4"
      " int 4 keycode 28 lineOrder 1 m33d 72 m33f 36 m44d 128 m44f 64 rational 8 tiledesc 9"
      " timecode 8 v2d 16 v2f 8 v2i 8 v3d 24 v3f 12 v3i 12 ";
  const std::size_t found = sizes.find(" " + type + " ");
  if (type.empty() || found == std::string_view::npos) return 0;
  std::uint32_t size = 0;
  for (std::size_t i = found + type.size() + 2; sizes[i] != ' '; ++i) {
    size = 10 * size + static_cast<std::uint32_t>(sizes[i] - '0');
  }
  return size;
}

/// The stream is where the value of a dataWindow begins.
void check_window(Imf::IStream& stream) {
  std::array<std::int64_t, 4> sides{};
  for (std::int64_t& side : sides) side = static_cast<std::int32_t>(little_endian(stream));
  const std::int64_t width = sides[2] - sides[0], height = sides[3] - sides[1];
  if (width < limits::max_image_side && height < limits::max_image_side) return;
  throw DecodeError(
      fmt::format("is {} x {} pixels, more than the limit of {} a side; scale it down", width + 1,
                  height + 1, limits::max_image_side));
}

}  // namespace

void check_exr_headers(Imf::IStream& stream, std::uint64_t bytes) {
  constexpr std::uint32_t several_parts = 0x1000;
  stream.seekg(4);
  const bool several = (little_endian(stream) & several_parts) != 0;
  for (bool more = true; more;) {
    more = false;  // several parts end in one without attributes
    for (std::string name = word_in(stream); !name.empty(); name = word_in(stream)) {
      const std::string type = word_in(stream);
      const std::uint32_t size = little_endian(stream);
      const std::uint64_t offset = stream.tellg();
      const std::uint32_t own = size_of(type);
      if (size > bytes - offset || (own != 0 && own != size)) {
        throw DecodeError("the header is damaged");
      }
      if (name == "dataWindow" && type == "box2i") check_window(stream);
      stream.seekg(offset + size);
      more = several;
    }
  }
  stream.seekg(0);
}

}  // namespace photile::image
