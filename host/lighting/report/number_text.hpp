// Numbers as people read them on plans and legends.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace photile::report {

/// A value with so many digits that count; large ones are whole numbers in place of powers of ten:
/// "12500", not "1.25e+04".
inline std::string number_text(double value, int digits) {
  const double size = std::abs(value);
  if (size >= std::pow(10.0, digits) - 0.5 && size < 1e9) return fmt::format("{:.0f}", value);
  return fmt::format("{:.{}g}", value, digits);
}

/// A value with so many digits as its standard error leaves meaning, which is given with one:
/// "230 +-30". Without an error, four digits.
inline std::string text_with_error(double value, double error) {
  if (!(error > 0) || !std::isfinite(error)) return number_text(value, 4);
  const double unit = std::pow(10.0, std::floor(std::log10(error)));
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(error))));
  return fmt::format("{:.{}f} +-{:.{}f}", unit * std::round(value / unit), decimals,
                     unit * std::round(error / unit), decimals);
}

/// A field as RFC 4180 has it: quoted where it must be.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace photile::report
