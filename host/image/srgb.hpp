// The sRGB transfer curve, exact in both pieces (IEC 61966-2-1).
#pragma once

#include <cstdint>

namespace photile::image {

double srgb_from_linear(double linear);   ///< [0,1] to [0,1]
double linear_from_srgb(double encoded);  ///< [0,1] to [0,1]

/// Nearest 8-bit code value of a linear value; NaN and negative values give 0, more than 1 gives
/// 255.
std::uint8_t srgb8_from_linear(float linear);

}  // namespace photile::image
