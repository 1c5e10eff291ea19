#include "image/picture_checks.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "image/picture_metadata.hpp"

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

/// libpng takes the memory that a text is said to have, up to two gigabytes.
void check_png(Encoded bytes) {
  constexpr std::size_t frame = 12;  // length, type and checksum
  for (std::size_t offset = 8; offset < bytes.size();) {
    const std::size_t length = number_at(bytes, offset, 4, ByteOrder::big);
    if (number_at(bytes, offset + 4, 4, ByteOrder::big) == 0x49454E44) return;  // IEND
    if (length + frame > bytes.size() - offset) throw DecodeError("the file ends too early");
    offset += length + frame;
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
    throw DecodeError(fmt::format("{} bits per pixel are not supported", bits));
  }
}

/// The reader looks texels up in the palette without checking its size.
void check_targa(Encoded bytes) {
  const bool palette = number_at(bytes, 2, 1) == 1 || number_at(bytes, 2, 1) == 9;
  const std::uint32_t first = number_at(bytes, 3, 2), colours = number_at(bytes, 5, 2),
                      bits = number_at(bytes, 16, 1);
  if (palette && (bits != 8 || first != 0 || colours < 256)) {
    throw DecodeError("only palettes of 256 colours are supported; save it in true colour");
  }
}

/// Without the tag the format has one bit a sample, and the reader takes eight.
void check_tiff(Encoded bytes) {
  constexpr std::uint32_t bits_per_sample = 258;
  if (tiff_entry(bytes, bits_per_sample)) return;
  throw DecodeError("the number of bits per sample is missing; save it with 8");
}

/// Runs hold zeros at 15.9 pixels a byte, and so less than in an EXR has to be refused.
void check_radiance(Encoded bytes) {
  constexpr std::uint64_t max_pixels_per_byte = limits::max_exr_pixels_per_byte / 2;
  const RadianceHeader header = read_radiance_header(bytes);
  const std::uint64_t pixels = std::uint64_t{header.rows} * header.columns;
  const std::size_t rest = bytes.size() - header.end;
  if (3 * sizeof(float) * pixels > unchecked_bytes && pixels >= rest * max_pixels_per_byte) {
    throw DecodeError(
        fmt::format("is damaged or empty: {} bytes for {} x {} pixels; the limit is {} pixels per "
                    "byte; scale it down",
                    rest, header.columns, header.rows, max_pixels_per_byte));
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
      "has {} channels ({} bytes decoded), more than the limit of {} ({}); remove channels or "
      "scale it down",
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
  constexpr std::array<std::pair<std::string_view, Check>, 7> checks{{{"png", check_png},
                                                                      {"gif", check_gif},
                                                                      {"webp", check_webp},
                                                                      {"bmp", check_bmp},
                                                                      {"targa", check_targa},
                                                                      {"tiff", check_tiff},
                                                                      {"hdr", check_radiance}}};
  for (const auto& [name, check] : checks) {
    if (name == reader) check(bytes);
  }
}

namespace {

/// Bytes of the types that have a fixed size (OpenEXR, "File Layout", predefined attributes).
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 24> sizes{{{"box2f", 16},
                                                                            {"box2i", 16},
                                                                            {"chromaticities", 32},
                                                                            {"compression", 1},
                                                                            {"deepImageState", 1},
                                                                            {"double", 8},
                                                                            {"envmap", 1},
                                                                            {"float", 4},
                                                                            {"int", 4},
                                                                            {"keycode", 28},
                                                                            {"lineOrder", 1},
                                                                            {"m33d", 72},
                                                                            {"m33f", 36},
                                                                            {"m44d", 128},
                                                                            {"m44f", 64},
                                                                            {"rational", 8},
                                                                            {"tiledesc", 9},
                                                                            {"timecode", 8},
                                                                            {"v2d", 16},
                                                                            {"v2f", 8},
                                                                            {"v2i", 8},
                                                                            {"v3d", 24},
                                                                            {"v3f", 12},
                                                                            {"v3i", 12}}};

std::uint64_t little_endian(Imf::IStream& stream, std::size_t size) {
  char text[8] = {};
  stream.read(text, static_cast<int>(size));
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(text[i]);
  return value;
}

class HeaderCheck {
 public:
  HeaderCheck(Imf::IStream& stream, std::uint64_t bytes) : stream_(stream), bytes_(bytes) {}

  std::uint64_t run() {
    constexpr std::uint32_t several_parts = 0x1000;
    stream_.seekg(4);
    const bool several = (number() & several_parts) != 0;
    for (bool more = true; more;) {
      const bool empty = read_header();
      more = several && !empty;
    }
    const std::uint64_t end = stream_.tellg();
    stream_.seekg(0);
    return end;
  }

 private:
  [[noreturn]] static void refuse() { throw DecodeError("the header is damaged"); }

  std::uint32_t number() { return static_cast<std::uint32_t>(little_endian(stream_, 4)); }

  std::string word() {
    std::string text;
    for (char letter = 0; text.size() < 256; text += letter) {
      stream_.read(&letter, 1);
      if (letter == '\0') return text;
    }
    refuse();
  }

  /// Whether the header has no attribute, which ends the list of parts.
  bool read_header() {
    std::size_t attributes = 0;
    for (std::string name = word(); !name.empty(); name = word(), ++attributes) {
      const std::string type = word();
      const std::uint32_t size = number();
      const std::uint64_t offset = stream_.tellg();
      if (size > bytes_ - offset) refuse();
      check_attribute(name, type, offset + size, size);
      stream_.seekg(offset + size);
    }
    return attributes == 0;
  }

  /// The stream is where its value begins.
  void check_attribute(const std::string& name, const std::string& type, std::uint64_t end,
                       std::uint32_t size) {
    const auto* const own = std::find_if(sizes.begin(), sizes.end(),
                                         [&](const auto& entry) { return entry.first == type; });
    if (own != sizes.end() && own->second != size) refuse();
    if (name == "dataWindow" && type == "box2i") check_window();
    if (type == "chlist") check_channels(end);
    if (type == "stringvector") check_texts(end);
    if (type == "preview") {
      if (size < 8) refuse();
      const std::uint64_t width = number(), height = number();
      if (width > size || height > size || 8 + 4 * width * height != size) refuse();
    }
    // Compressed, for deep pixels, which are not read.
    if (type == "idmanifest") throw DecodeError("has an ID manifest; remove it");
  }

  void check_window() {
    const auto left = static_cast<std::int32_t>(number()),
               top = static_cast<std::int32_t>(number()),
               right = static_cast<std::int32_t>(number()),
               bottom = static_cast<std::int32_t>(number());
    const std::int64_t width = std::int64_t{right} - left, height = std::int64_t{bottom} - top;
    if (width < limits::max_image_side && height < limits::max_image_side) return;
    throw DecodeError(
        fmt::format("is {} x {} pixels, more than the limit of {} a side; scale it down", width + 1,
                    height + 1, limits::max_image_side));
  }

  /// Names, each with 16 bytes, up to an empty one at the end.
  void check_channels(std::uint64_t end) {
    constexpr std::uint64_t bytes_of_channel = 16;
    while (!word().empty()) {
      if (stream_.tellg() + bytes_of_channel > end) refuse();
      stream_.seekg(stream_.tellg() + bytes_of_channel);
    }
    if (stream_.tellg() != end) refuse();
  }

  /// Texts, each with its length before it.
  void check_texts(std::uint64_t end) {
    while (stream_.tellg() < end) {
      if (end - stream_.tellg() < 4) refuse();
      const std::uint64_t length = number();
      if (length > end - stream_.tellg()) refuse();
      stream_.seekg(stream_.tellg() + length);
    }
  }

  Imf::IStream& stream_;
  const std::uint64_t bytes_;
};

/// Bytes of the block at an offset, with what is before its pixels: its part where a file may have
/// several, its row or its tile and level, its size.
std::uint64_t block_bytes(Imf::IStream& stream, std::uint64_t offset, bool several,
                          const std::vector<bool>& tiled) {
  stream.seekg(offset);
  const std::uint64_t part = several ? little_endian(stream, 4) : 0;
  if (part >= tiled.size()) throw DecodeError("a block of pixels is damaged");
  for (int i = 0; i < (tiled[part] ? 4 : 1); ++i) little_endian(stream, 4);
  const std::uint64_t size = little_endian(stream, 4);
  return stream.tellg() - offset + size;
}

}  // namespace

std::uint64_t check_exr_headers(Imf::IStream& stream, std::uint64_t bytes) {
  return HeaderCheck(stream, bytes).run();
}

// OpenEXR, "File Layout": the tables of all parts, of 8 bytes a block, lie before the first block.
std::uint64_t exr_pixel_bytes(Imf::IStream& stream, std::uint64_t table, std::uint64_t bytes,
                              std::uint64_t entries, const std::vector<bool>& tiled) {
  constexpr std::uint64_t several_parts = 0x1000;
  const std::uint64_t before = stream.tellg();
  stream.seekg(4);
  const bool several = (little_endian(stream, 4) & several_parts) != 0;
  constexpr std::uint64_t entry_bytes = 8;
  std::uint64_t end = table + std::min(entries, (bytes - table) / entry_bytes) * entry_bytes,
                sum = 0, first = bytes;
  for (std::uint64_t entry = table; entry + entry_bytes <= end; entry += entry_bytes) {
    stream.seekg(entry);
    const std::uint64_t offset = little_endian(stream, entry_bytes);
    if (offset == 0) continue;
    if (offset >= bytes) throw DecodeError("a block of pixels is not within the file");
    first = std::min(first, offset);
    end = std::min(end, offset);
    sum += entry_bytes + std::min(block_bytes(stream, offset, several, tiled), bytes - offset);
  }
  stream.seekg(before);
  // Of a window with fewer blocks than were written, OpenEXR would read the first as these.
  if (sum > 0 && first > table + entries * entry_bytes) {
    throw DecodeError("the header is damaged: its window has fewer blocks of pixels than the file");
  }
  // A file whose writer was ended before it wrote the table: OpenEXR looks for the blocks.
  return sum == 0 ? bytes - end : sum;
}

namespace {

/// The decoded size of runs of equal bytes; where the data is wrong, another number.
std::uint64_t bytes_of_runs(std::string_view coded) {
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < coded.size();) {
    const auto count = static_cast<signed char>(coded[i]);
    bytes += static_cast<std::uint64_t>(count < 0 ? -count : count + 1);
    i += static_cast<std::size_t>(count < 0 ? 1 - count : 2);
  }
  return bytes;
}

std::uint64_t inflated_bytes(std::string_view deflated, std::uint64_t most) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(deflated.data()));
  stream.avail_in = static_cast<uInt>(deflated.size());
  std::array<Bytef, 1 << 14> out;
  int status = Z_OK;
  while (status == Z_OK && stream.total_out <= most) {
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    status = inflate(&stream, Z_NO_FLUSH);
  }
  const std::uint64_t bytes = stream.total_out;
  inflateEnd(&stream);
  return bytes;
}

}  // namespace

void check_exr_block(Imf::IStream& stream, std::uint64_t table, const ExrBlock& block, bool tiled) {
  constexpr std::uint64_t several_parts = 0x1000;
  constexpr int entry_bytes = 8;
  if (block.compression > Imf::ZIP_COMPRESSION) return;
  const std::uint64_t before = stream.tellg();
  stream.seekg(4);
  const bool several = (little_endian(stream, 4) & several_parts) != 0;
  stream.seekg(table + entry_bytes * block.entry);
  if (const std::uint64_t offset = little_endian(stream, entry_bytes); offset != 0) {
    stream.seekg(offset);
    for (int i = 0; i < (several ? 1 : 0) + (tiled ? 4 : 1); ++i) little_endian(stream, 4);
    std::uint64_t found = little_endian(stream, 4);
    // Where compressing would not make it smaller, it is as it is.
    if (found < block.bytes && block.compression != Imf::NO_COMPRESSION) {
      std::string coded(found, '\0');
      stream.read(coded.data(), static_cast<int>(found));
      found = block.compression == Imf::RLE_COMPRESSION ? bytes_of_runs(coded)
                                                        : inflated_bytes(coded, block.bytes);
    }
    if (found != block.bytes) {
      throw DecodeError("the header is damaged: its window is not that of the pixels");
    }
  }
  stream.seekg(before);
}

}  // namespace photile::image
