// glTF's binary form: a header, a chunk of JSON, and one of the buffer.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace photile::gltf {

/// A .glb in its parts, views of its bytes. What a file lacks they lack.
struct BinaryFile {
  static constexpr std::size_t header = 12, chunk_header = 8, alignment = 4;  ///< bytes
  static_assert(std::endian::native == std::endian::little);

  std::string_view json;
  std::string_view rest;  ///< all that follows the JSON

  static bool is(std::string_view bytes) { return bytes.starts_with("glTF"); }

  explicit BinaryFile(std::string_view bytes) {
    if (bytes.size() <= header + chunk_header) return;
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + header, sizeof length);
    json = bytes.substr(header + chunk_header, length);
    rest = bytes.substr(header + chunk_header + json.size());
  }

  static std::string number(std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&word), sizeof word};
  }

  /// A file up to the end of its JSON; `rest` further bytes follow.
  static std::string head(std::string json, std::size_t rest) {
    json.append((alignment - json.size() % alignment) % alignment, ' ');
    const std::size_t size = header + chunk_header + json.size() + rest;
    return "glTF" + number(2) + number(size) + number(json.size()) + "JSON" + json;
  }

  /// What begins the chunk of a buffer, whose bytes are a multiple of four.
  static std::string buffer_head(std::size_t bytes) {
    return number(bytes) + std::string("BIN\0", chunk_header / 2);
  }
};

}  // namespace photile::gltf
