// Numbers as people read them on plans and legends.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace photile::measuring {

/// A value with so many digits that count; large ones are whole numbers in place of powers of ten:
/// "12500", not "1.25e+04".
inline std::string number_text(double value, int digits) {
  const double size = std::abs(value);
  if (size >= std::pow(10.0, digits) - 0.5 && size < 1e9) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}g}", value, digits);
}

}  // namespace photile::measuring
