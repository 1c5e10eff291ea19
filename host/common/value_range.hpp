// The values that a setting, or an option of the command, can have, and how a refusal names them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace photile {

using SettingValue = std::variant<std::uint64_t, double, std::string_view>;

struct WholeNumbers {
  std::uint64_t least, most;
};
struct Numbers {
  double least, most;
};
/// Those that are neither zero nor infinite as floats, which the kernels compute with.
struct PositiveNumbers {};
struct Words {
  std::vector<std::string_view> words;
};
using ValueRange = std::variant<WholeNumbers, Numbers, PositiveNumbers, Words>;

/// "1000000", "0.25", "clipped".
std::string text_of(const SettingValue& value);

/// "a whole number from 1 to 4096", "one of disc, clipped".
std::string text_of(const ValueRange& range);

/// False for a NaN, and for a value of another kind.
bool contains(const ValueRange& range, const SettingValue& value);

/// "'0' is not a whole number from 1 to 4096".
std::string out_of_range(std::string_view found, const ValueRange& range);

}  // namespace photile
