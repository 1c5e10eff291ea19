// Radiance's pictures: G. Ward, "Real Pixels", Graphics Gems II, and Radiance's color.c.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "image/formats/formats.hpp"
#include "image/unchecked_bytes.hpp"
#include "photile/limits.hpp"

namespace photile::image {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Runs hold zeros at 15.9 pixels a byte, and so less than in an EXR has to be refused.
constexpr std::uint64_t max_pixels_per_byte = limits::max_exr_pixels_per_byte / 2;

class RadianceDecoder : public Decoder {
 public:
  explicit RadianceDecoder(Encoded bytes) : rest_(bytes) {
    for (std::string_view text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe") {
        throw DecodeError(fmt::format("'{}' is not read; convert it with ra_rgbe", text));
      }
    }
    const std::string_view size = line();
    shape_ = {number(size, "+X "), number(size, "-Y "), 3, Sample::real};
    if (!size.starts_with("-Y ")) throw DecodeError("only rows from the top are read");
    const std::uint64_t pixels = shape_.values() / 3;
    if (shape_.bytes() > unchecked_bytes && pixels >= rest_.size() * max_pixels_per_byte) {
      throw DecodeError(fmt::format(
          "is damaged or empty: {} bytes for {} x {} pixels; the limit is {} pixels a byte; scale "
          "it down",
          rest_.size(), shape_.width, shape_.height, max_pixels_per_byte));
    }
  }

  Pixels decode() override {
    std::vector<float> values;
    // A row takes at least 2 bytes for each 127 pixels: no room for what cannot be there.
    if (shape_.values() / 3 > rest_.size() * 64) throw DecodeError("the file ends too early");
    values.reserve(shape_.values());
    std::vector<Rgbe> row(static_cast<std::size_t>(shape_.width));
    for (int y = 0; y < shape_.height; ++y) {
      read(row);
      for (const Rgbe& pixel : row) {
        const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - (128 + 8));
        for (std::size_t c = 0; c < 3; ++c) values.push_back(pixel[c] * scale);
      }
    }
    return values;
  }

 private:
  std::string_view line() {
    const std::string_view text(reinterpret_cast<const char*>(rest_.data()), rest_.size());
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) throw DecodeError("the header is damaged");
    rest_ = rest_.subspan(end + 1);
    return text.substr(0, end);
  }

  static int number(std::string_view text, std::string_view sign) {
    const std::size_t place = text.find(sign);
    int value = 0;
    if (place != std::string_view::npos) {
      std::from_chars(text.data() + place + sign.size(), text.data() + text.size(), value);
    }
    if (value < 1) throw DecodeError(fmt::format("'{}' is no size that is read", text));
    return value;
  }

  std::uint8_t byte() {
    if (rest_.empty()) throw DecodeError("the file ends too early");
    const std::uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }

  void read(std::vector<Rgbe>& row) {
    Rgbe first{byte(), byte(), byte(), byte()};
    const bool planes = row.size() >= 8 && row.size() < 32768 && first[0] == 2 && first[1] == 2 &&
                        first[2] * 256u + first[3] == row.size();
    planes ? read_planes(row) : read_pixels(row, first);
  }

  /// Each component of a row by itself, in runs.
  void read_planes(std::vector<Rgbe>& row) {
    for (std::size_t component = 0; component < 4; ++component) {
      for (std::size_t x = 0; x < row.size();) {
        const std::uint8_t code = byte();
        const bool run = code > 128;
        const std::size_t count = run ? code - 128u : code;
        if (count == 0 || count > row.size() - x) throw DecodeError("a row is damaged");
        std::uint8_t value = run ? byte() : std::uint8_t{0};
        for (const std::size_t end = x + count; x < end; ++x) {
          row[x][component] = run ? value : byte();
        }
      }
    }
  }

  /// Pixel by pixel; 1, 1, 1, n repeats the last one n times, more of them in a row n times 256.
  void read_pixels(std::vector<Rgbe>& row, Rgbe pixel) {
    unsigned shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t count = std::size_t{pixel[3]} << shift;
        if (x == 0 || shift > 16 || count > row.size() - x) throw DecodeError("a row is damaged");
        for (const std::size_t end = x + count; x < end; ++x) row[x] = row[x - 1];
        shift += 8;
      } else {
        row[x++] = pixel;
        shift = 0;
      }
      if (x < row.size()) pixel = {byte(), byte(), byte(), byte()};
    }
  }

  Encoded rest_;
};

}  // namespace

std::unique_ptr<Decoder> open_radiance(Encoded bytes) {
  return std::make_unique<RadianceDecoder>(bytes);
}

}  // namespace photile::image
