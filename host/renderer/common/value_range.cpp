#include "common/value_range.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "photile/errors.hpp"

namespace photile {
namespace {

/// The range of floats that have all of their digits.
constexpr double least_positive = std::numeric_limits<float>::min(),
                 most_positive = std::numeric_limits<float>::max();

std::string range_text(const WholeNumbers& range) {
  return range.most == std::numeric_limits<std::uint64_t>::max()
             ? fmt::format("a whole number from {}", range.least)
             : fmt::format("a whole number from {} to {}", range.least, range.most);
}

std::string range_text(const Numbers& range) {
  return fmt::format("a number from {} to {}", range.least, range.most);
}

std::string range_text(const PositiveNumbers&) { return "a number greater than 0"; }

std::string range_text(const Words& range) {
  return fmt::format("one of {}", fmt::join(range.words, ", "));
}

std::string range_text(const Text& range) { return std::string(range.form); }

bool holds(const WholeNumbers& range, std::uint64_t value) {
  return value >= range.least && value <= range.most;
}

bool holds(const Numbers& range, double value) {
  return value >= range.least && value <= range.most;
}

bool holds(const PositiveNumbers&, double value) {
  return value >= least_positive && value <= most_positive;
}

bool holds(const Words& range, std::string_view value) {
  return std::find(range.words.begin(), range.words.end(), value) != range.words.end();
}

bool holds(const Text&, std::string_view value) { return !value.empty(); }

template <class Range, class Value>
bool holds(const Range&, const Value&) {
  return false;
}

}  // namespace

double shortest_double(float value) {
  return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

std::string text_of(const SettingValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

std::string text_of(const ValueRange& range) {
  return std::visit([](const auto& r) { return range_text(r); }, range);
}

bool contains(const ValueRange& range, const SettingValue& value) {
  return std::visit([](const auto& r, const auto& v) { return holds(r, v); }, range, value);
}

void check_value(std::string_view name, const SettingValue& value, const ValueRange& range) {
  if (contains(range, value)) return;
  throw UsageError(fmt::format("{}: {}", name, out_of_range(text_of(value), range)));
}

std::string out_of_range(std::string_view found, const ValueRange& range) {
  // Otherwise the message would say that 1e300 is not a number greater than 0.
  const std::string bounds =
      std::holds_alternative<PositiveNumbers>(range)
          ? fmt::format(", from {:.2g} to {:.2g}", least_positive, most_positive)
          : "";
  return fmt::format("'{}' is not {}{}", found, text_of(range), bounds);
}

}  // namespace photile
