#include "command/number_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/number_text.hpp"

namespace photile::app {

std::string format_count(double count) {
  static constexpr std::array suffixes{"", "k", "M", "G", "T"};
  std::size_t suffix = 0;
  // 999.5 would be printed as 1e+03.
  while (std::abs(count) >= 999.5 && suffix + 1 < suffixes.size()) {
    count /= 1000;
    ++suffix;
  }
  if (suffix == 0) return fmt::format("{:.3g}", count);
  return fmt::format("{:.1f}{}", count, suffixes[suffix]);
}

std::string format_bytes(std::uint64_t bytes) {
  static constexpr std::array suffixes{"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return fmt::format("{} B", bytes);
  double value = static_cast<double>(bytes) / 1024;
  std::size_t suffix = 0;
  while (value >= 1024 && suffix + 1 < suffixes.size()) {
    value /= 1024;
    ++suffix;
  }
  return fmt::format("{:.1f} {}", value, suffixes[suffix]);
}

std::string format_seconds(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 9.995) return fmt::format("{:.2f} s", seconds);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string unit_symbol(PowerUnit unit) { return unit == PowerUnit::lumen ? "lm" : "W"; }

std::string format_number(double value, int digits) {
  std::string text = report::number_text(value, digits);
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  const std::size_t end = std::min(text.find_first_not_of("0123456789", sign), text.size());
  constexpr std::size_t most_ungrouped = 4;
  if (end - sign <= most_ungrouped) return text;
  for (std::size_t place = end; place > sign + 3;) text.insert(place -= 3, 1, ',');
  return text;
}

std::string format_power(double power, PowerUnit unit) {
  return format_number(power, 4) + " " + unit_symbol(unit);
}

std::string format_power_in_both(double power, PowerUnit unit, double lumen_per_watt) {
  const bool lumen = unit == PowerUnit::lumen;
  const std::string other = lumen ? format_power(power / lumen_per_watt, PowerUnit::watt)
                                  : format_power(power * lumen_per_watt, PowerUnit::lumen);
  return format_power(power, unit) + " (" + other + ")";
}

}  // namespace photile::app
