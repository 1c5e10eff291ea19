// The values that a setting, or an option of the command, can have, and how a refusal names them.
#pragma once

#include <concepts>
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
/// Numbers that are neither zero nor infinite as floats, which the kernels compute with.
struct PositiveNumbers {};
struct Words {
  std::vector<std::string_view> words;
};
/// Any text; the code that reads it checks it.
struct Text {
  std::string_view form;  ///< "NAME or INDEX"
};
using ValueRange = std::variant<WholeNumbers, Numbers, PositiveNumbers, Words, Text>;

/// "1000000", "0.25", "clipped".
std::string text_of(const SettingValue& value);

/// "a whole number from 1 to 4096", "one of disc, clipped".
std::string text_of(const ValueRange& range);

/// False for NaN, and for a value of another kind.
bool contains(const ValueRange& range, const SettingValue& value);

/// "'0' is not a whole number from 1 to 4096".
std::string out_of_range(std::string_view found, const ValueRange& range);

/// Errors: UsageError "name: '-1' is not a number greater than 0".
void check_value(std::string_view name, const SettingValue& value, const ValueRange& range);

/// The double with the float's shortest text: 0.1 for 0.1f.
double shortest_double(float value);
inline double shortest_double(double value) { return value; }

/// A field of parameters that is not a word.
template <class T>
SettingValue setting_value(const T& field) {
  if constexpr (std::integral<T>) {
    // A negative number becomes one that is in no range of whole numbers.
    if (field < T{0}) return static_cast<double>(field);
    return static_cast<std::uint64_t>(field);
  } else {
    return shortest_double(field);
  }
}

/// Refuses what is out of the range in the table of settings (render/setting.hpp): for stages that
/// can be called without a rendering. Errors: UsageError, which names the setting.
void check_setting(std::string_view name, const SettingValue& value);

}  // namespace photile
