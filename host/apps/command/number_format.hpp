// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

#include "photile/scene.hpp"

namespace photile::app {

/// 950, "1.9k", "4.0M", "1.2G": three digits at most before the point.
std::string format_count(double count);

/// "512 B", "1.5 KiB", "340.0 MiB"
std::string format_bytes(std::uint64_t bytes);

/// "0.12 s", "12.3 s", "2 min 05 s", "1 h 02 min"
std::string format_seconds(double seconds);

/// So many digits, with groups of three from 10,000 on: "0.5857", "6000", "11,990".
std::string format_number(double value, int digits);

/// "800 lm" or "5 W"
std::string format_power(double power, PowerUnit unit);

/// The same power in both units: "800 lm (1.171 W)".
std::string format_power_in_both(double power, PowerUnit unit, double lumen_per_watt);

/// "lm" or "W"
std::string unit_symbol(PowerUnit unit);

}  // namespace photile::app
