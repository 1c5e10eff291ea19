// sRGB written out again, for tests of what the library makes of it.
#pragma once

#include <cmath>

namespace photile::test {

/// sRGB byte to linear, from IEC 61966-2-1.
inline double linear(double byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace photile::test
