#include "image/srgb.hpp"

#include <algorithm>
#include <cmath>

namespace photile::image {

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::uint8_t srgb8_from_linear(float linear) {
  if (!(linear > 0.0f)) return 0;  // NaN too
  const double encoded = srgb_from_linear(std::min(linear, 1.0f));
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

}  // namespace photile::image
