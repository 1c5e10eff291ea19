#include "image/exr_headers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "image/decoder.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

/// Bytes of the types that have a size of their own (OpenEXR, "File Layout", predefined
/// attributes).
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

  /// Whether it has no attribute: the end of several parts.
  bool read_header() {
    std::size_t attributes = 0;
    for (std::string name = word(); !name.empty(); name = word(), ++attributes) {
      const std::string type = word();
      const std::uint32_t size = number();
      const std::uint64_t place = stream_.tellg();
      if (size > bytes_ - place) refuse();
      check_attribute(name, type, place + size, size);
      stream_.seekg(place + size);
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
    if (type == "idmanifest") throw DecodeError("has a manifest of identities; leave it out");
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

/// Of the block at a place, with what is before its pixels: its part where a file may have several,
/// its row or its tile and level, its size.
std::uint64_t block_bytes(Imf::IStream& stream, std::uint64_t place, bool several,
                          const std::vector<bool>& tiled) {
  stream.seekg(place);
  const std::uint64_t part = several ? little_endian(stream, 4) : 0;
  if (part >= tiled.size()) throw DecodeError("a block of pixels is damaged");
  for (int i = 0; i < (tiled[part] ? 4 : 1); ++i) little_endian(stream, 4);
  const std::uint64_t size = little_endian(stream, 4);
  return stream.tellg() - place + size;
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
                sum = 0;
  for (std::uint64_t entry = table; entry + entry_bytes <= end; entry += entry_bytes) {
    stream.seekg(entry);
    const std::uint64_t place = little_endian(stream, entry_bytes);
    if (place == 0) continue;
    if (place >= bytes) throw DecodeError("a block of pixels is not within the file");
    end = std::min(end, place);
    sum += entry_bytes + std::min(block_bytes(stream, place, several, tiled), bytes - place);
  }
  stream.seekg(before);
  // A file whose writer was ended before it wrote the table: OpenEXR looks for the blocks.
  return sum == 0 ? bytes - end : sum;
}

}  // namespace photile::image
