#include "photometry/photometric_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/warnings.hpp"

namespace photile::photometry {
namespace {

constexpr std::string_view separators = " \t\f\v,\x1A";  // old files end with Ctrl-Z
constexpr std::size_t longest_shown = 20;

/// A token as a message can show it.
std::string shown(std::string_view token) {
  std::string text(token.substr(0, longest_shown));
  std::replace_if(
      text.begin(), text.end(),
      [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E;
      },
      '?');
  return text;
}

}  // namespace

std::string_view NumberReader::token() {
  for (; line_ < lines_.size(); ++line_, column_ = 0) {
    const std::string_view line = lines_[line_];
    const std::size_t first = line.find_first_not_of(separators, column_);
    if (first == std::string_view::npos) continue;
    column_ = std::min(line.find_first_of(separators, first), line.size());
    return line.substr(first, column_ - first);
  }
  return {};
}

std::string NumberReader::place() const { return fmt::format("line {}", line_ + 1); }

double NumberReader::number(const std::string& what) {
  const std::string_view text = token();
  if (text.empty()) throw files::ResourceError(fmt::format("the file ends before the {}", what));
  const auto value = parse_signed(text);
  if (!value) {
    throw files::ResourceError(
        fmt::format("{}: '{}' is no number, for the {}", place(), shown(text), what));
  }
  return *value;
}

std::size_t NumberReader::count(const std::string& what, std::uint64_t lowest,
                                std::uint64_t highest) {
  const double value = number(what);
  if (value != std::floor(value) || value < static_cast<double>(lowest) ||
      value > static_cast<double>(highest)) {
    throw files::ResourceError(fmt::format("{}: the {} is {}, not a whole number from {} to {}",
                                           place(), what, value, lowest, highest));
  }
  return static_cast<std::size_t>(value);
}

std::vector<double> NumberReader::numbers(const std::string& what, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(number(fmt::format("{} {} of {}", what, i + 1, count)));
  }
  return values;
}

}  // namespace photile::photometry
