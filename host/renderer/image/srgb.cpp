#include "image/srgb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "image/pixel_lights.hpp"

namespace photile::image {
namespace {

std::uint8_t rounded_code(float linear) {
  return static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(linear)));
}

/// Code values by looking them up: a picture asks millions of times, and a power takes long. The
/// upper half of a float's bits leads to the code of the least value that begins with them; those
/// between it and the value, two at most, are stepped over.
class CodeTable {
 public:
  CodeTable() {
    for (std::uint32_t half = 0; half < code_at_.size(); ++half) {
      code_at_[half] = rounded_code(std::bit_cast<float>(half << 16));
    }
    for (int code = 1; code < 256; ++code) least_[code] = least_value_of(code);
  }

  /// Of a value in (0, 1].
  std::uint8_t operator()(float linear) const {
    std::uint8_t code = code_at_[std::bit_cast<std::uint32_t>(linear) >> 16];
    while (code < 255 && linear >= least_[code + 1]) ++code;
    return code;
  }

 private:
  /// By bisection among the floats, whose order is that of their bits.
  static float least_value_of(int code) {
    std::uint32_t below = 0, found = std::bit_cast<std::uint32_t>(1.0f);
    while (found - below > 1) {
      const std::uint32_t middle = below + (found - below) / 2;
      (rounded_code(std::bit_cast<float>(middle)) >= code ? found : below) = middle;
    }
    return std::bit_cast<float>(found);
  }

  static constexpr std::uint32_t halves = (std::bit_cast<std::uint32_t>(1.0f) >> 16) + 1;
  std::array<std::uint8_t, halves> code_at_;
  std::array<float, 256> least_{};  ///< value of each code; of 0, 0
};

}  // namespace

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb8_from_linear(float linear) {
  static const CodeTable table;
  if (!(linear > 0.0f)) return 0;  // NaN too
  return table(std::min(linear, 1.0f));
}

std::vector<std::uint8_t> srgb8_texels(const Image& display_referred) {
  std::vector<std::uint8_t> texels(3 * display_referred.pixels());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = *display_referred.find(std::string(1, "RGB"[channel]));
    for_each_pixel(plane.size(), [&](std::size_t pixel) {
      texels[3 * pixel + channel] = srgb8_from_linear(plane[pixel]);
    });
  }
  return texels;
}

}  // namespace photile::image
