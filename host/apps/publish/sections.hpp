// Arrays of a page: coded so that they pack well, packed, and listed in a table that the page reads
// (page/data.js).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace photile::publish {

/// Steps of the luminance of a coded texel to a factor of two, factors of two below the brightest
/// texel of its picture that are kept, and steps of the part that red, or blue, has in the sum of
/// the channels. A luminance is off by 0.27% at most: half a step of a display's 8 bits is more.
inline constexpr int steps_per_octave = 128, octaves = 20, chroma_steps = 511;

/// Appends arrays. Bytes of numbers lie in planes, the lowest bytes first; each array is packed by
/// zlib.
class Sections {
 public:
  ///   level   of packing, 1 (quickest) to 9 (smallest)
  explicit Sections(int level) : level_(level) {}

  void add_bytes(const std::string& name, std::span<const std::uint8_t> bytes);
  void add_floats(const std::string& name, std::span<const float> numbers);
  void add_words(const std::string& name, std::span<const std::uint16_t> numbers);
  /// Differences of each number to the one before.
  void add_indices(const std::string& name, std::span<const std::uint32_t> numbers);

  /// Linear colours that are not negative: three planes of words, each less what its neighbours to
  /// the left and above predict (the median edge detector of JPEG-LS: Weinberger, Seroussi and
  /// Sapiro, "The LOCO-I lossless image compression algorithm", 2000). Row 0 first. Returns the
  /// luminance that the brightest code stands for.
  double add_light(const std::string& name, std::span<const glm::vec3> texels, std::size_t width);

  /// Four bytes a texel, in planes, predicted in the same way: red and blue less green, plus 128.
  void add_texture(const std::string& name, std::span<const std::uint8_t> rgba, std::size_t width);

  const nlohmann::json& table() const { return table_; }
  const std::string& bytes() const { return bytes_; }

 private:
  void add(const std::string& name, std::span<const std::uint8_t> bytes, const char* coding);

  const int level_;
  nlohmann::json table_ = nlohmann::json::object();
  std::string bytes_;
};

}  // namespace photile::publish
