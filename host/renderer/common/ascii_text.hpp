// Text of ASCII letters, whatever the locale says: case, blanks, lines and numbers.
#pragma once

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace photile {

/// ASCII letters in lower case.
std::string lower(std::string_view text);

/// Whether a text ends in `ending`, whatever the case of both.
bool ends_in(std::string_view text, std::string_view ending);

/// Without blanks, carriage returns and the Ctrl-Z of old files at either end.
std::string_view trimmed(std::string_view text);

/// Lines without their ends (LF, CR LF or CR) and without a byte-order mark.
std::vector<std::string_view> lines_of(std::string_view text);

/// Letters to insert, remove or replace (Levenshtein, "Binary codes capable of correcting
/// deletions, insertions and reversals", 1966).
std::size_t edits_between(std::string_view a, std::string_view b);

/// The word with the fewest edits between it and `text`; "" where there are no words.
std::string_view nearest_word(std::string_view text, std::span<const std::string_view> words);

/// The word of an enumerator, from a list of the words of all enumerators, in order.
template <class Enum>
std::string_view name_in(std::initializer_list<std::string_view> words, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < words.size() ? words.begin()[index] : "unknown";
}

/// The number that the whole of a text spells, with a decimal point, in digits of `base` for whole
/// numbers. Nothing for NaN, infinities and all else.
template <class Number>
std::optional<Number> parse_number(std::string_view text, int base = 10) {
  Number value{};
  const char* const end = text.data() + text.size();
  std::from_chars_result read{};
  if constexpr (std::is_floating_point_v<Number>) {
    read = std::from_chars(text.data(), end, value);
    if (!std::isfinite(value)) return std::nullopt;
  } else {
    read = std::from_chars(text.data(), end, value, base);
  }
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

/// A number, where a leading + is allowed.
std::optional<double> parse_signed(std::string_view text);

}  // namespace photile
