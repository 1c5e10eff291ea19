#include "image/picture_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "common/ascii_text.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

enum class Order { little, big };

/// The number in `count` bytes. Errors: DecodeError where the file ends before them.
std::uint32_t number_at(Encoded bytes, std::size_t place, std::size_t count,
                        Order order = Order::little) {
  if (place > bytes.size() || count > bytes.size() - place) {
    throw DecodeError("the file ends too early");
  }
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | bytes[place + (order == Order::big ? i : count - 1 - i)];
  }
  return value;
}

/// libpng takes the memory that a text is said to have, up to two gigabytes.
void check_png(Encoded bytes) {
  constexpr std::size_t frame = 12;  // length, type and checksum
  for (std::size_t place = 8; place < bytes.size();) {
    const std::size_t length = number_at(bytes, place, 4, Order::big);
    if (number_at(bytes, place + 4, 4, Order::big) == 0x49454E44) return;  // IEND
    if (length + frame > bytes.size() - place) throw DecodeError("the file ends too early");
    place += length + frame;
  }
  throw DecodeError("the file ends too early");
}

/// The reader takes memory for the whole picture when it opens one.
void check_canvas(std::uint32_t width, std::uint32_t height, Encoded bytes) {
  check_shape({static_cast<int>(width), static_cast<int>(height), 4, Sample::byte}, bytes.size());
}

void check_gif(Encoded bytes) {
  check_canvas(number_at(bytes, 6, 2), number_at(bytes, 8, 2), bytes);
}

void check_webp(Encoded bytes) {
  constexpr std::uint32_t most = 0x3FFF;
  switch (number_at(bytes, 12, 4, Order::big)) {
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

/// The reader looks texels up in the palette without asking whether it has so many.
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
  const Order order = number_at(bytes, 0, 1) == 'M' ? Order::big : Order::little;
  const std::size_t directory = number_at(bytes, 4, 4, order);
  const std::size_t entries = number_at(bytes, directory, 2, order);
  for (std::size_t i = 0; i < entries; ++i) {
    constexpr std::uint32_t bits_per_sample = 258;
    if (number_at(bytes, directory + 2 + 12 * i, 2, order) == bits_per_sample) return;
  }
  throw DecodeError("the number of bits per sample is missing; save it with 8");
}

/// Rows from the top in RGB are read. Runs hold zeros at 15.9 pixels a byte, and so less than in an
/// EXR has to be refused.
void check_radiance(Encoded bytes) {
  constexpr std::uint64_t max_pixels_per_byte = limits::max_exr_pixels_per_byte / 2;
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto line = [&] {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) throw DecodeError("the header is damaged");
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return text;
  };
  bool rgbe = false;
  for (std::string_view text = line(); !text.empty(); text = line()) {
    rgbe |= text == "FORMAT=32-bit_rle_rgbe";
  }
  if (!rgbe) throw DecodeError("is not of the format 32-bit_rle_rgbe; convert it with ra_rgbe");
  const std::string_view size = line();
  const std::size_t across = size.find(" +X ");
  if (!size.starts_with("-Y ") || across == std::string_view::npos) {
    throw DecodeError("only rows from the top are read");
  }
  const auto height = parse_number<std::uint32_t>(trimmed(size.substr(3, across - 3))),
             width = parse_number<std::uint32_t>(trimmed(size.substr(across + 4)));
  if (!width || !height) throw DecodeError("the size is damaged");
  const std::uint64_t pixels = std::uint64_t{*width} * *height;
  if (3 * sizeof(float) * pixels > unchecked_bytes && pixels >= rest.size() * max_pixels_per_byte) {
    throw DecodeError(fmt::format(
        "is damaged or empty: {} bytes for {} x {} pixels; the limit is {} pixels a byte; scale "
        "it down",
        rest.size(), *width, *height, max_pixels_per_byte));
  }
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

void check_encoded(PictureFormat format, Encoded bytes) {
  switch (format) {
    case PictureFormat::png:
      return check_png(bytes);
    case PictureFormat::gif:
      return check_gif(bytes);
    case PictureFormat::webp:
      return check_webp(bytes);
    case PictureFormat::bmp:
      return check_bmp(bytes);
    case PictureFormat::targa:
      return check_targa(bytes);
    case PictureFormat::tiff:
      return check_tiff(bytes);
    case PictureFormat::radiance:
      return check_radiance(bytes);
    default:
      return;
  }
}

}  // namespace photile::image
