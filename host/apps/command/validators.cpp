#include "command/validators.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/limits.hpp"
#include "walk/frames.hpp"

namespace photile::app {
namespace {

/// A number that is whole up to rounding (1.1M is) and fits 64 bits.
std::optional<std::uint64_t> whole(double number) {
  const double value = std::round(number);
  constexpr double beyond = 18446744073709551616.0;  // 2^64
  constexpr double rounding = 1e-12;                 // of a factor such as 1.1M
  if (!(std::abs(number - value) <= rounding * value) || value >= beyond) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

struct Unit {
  std::string_view name;
  double factor;
};

/// The number before the first of `units` that ends `text`, times its factor.
std::optional<double> parse_with_unit(std::string_view text, std::span<const Unit> units) {
  for (const Unit& unit : units) {
    if (!text.ends_with(unit.name)) continue;
    const auto number = parse_number<double>(text.substr(0, text.size() - unit.name.size()));
    return number ? std::optional(*number * unit.factor) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> parse_count(std::string_view text) {
  // Digits alone keep all 64 bits; a double would round a large seed.
  if (const auto digits = parse_number<std::uint64_t>(text)) return digits;
  static constexpr std::array<Unit, 7> units{
      {{"k", 1e3}, {"K", 1e3}, {"m", 1e6}, {"M", 1e6}, {"g", 1e9}, {"G", 1e9}, {"", 1}}};
  const auto number = parse_with_unit(text, units);
  return number ? whole(*number) : std::nullopt;
}

std::optional<double> parse_share(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  const auto number = parse_number<double>(text);
  if (!number || *number <= 0) return std::nullopt;
  return percent ? *number / 100 : *number;
}

std::optional<double> parse_duration(std::string_view text) {
  // "ms" before "s": the first that matches is taken.
  static constexpr std::array<Unit, 3> units{{{"min", 60}, {"ms", 1e-3}, {"s", 1}}};
  const auto seconds = parse_with_unit(text, units);
  return seconds > 0.0 ? seconds : std::nullopt;
}

std::optional<PixelSize> parse_size(std::string_view text) {
  const auto separator = text.find('x');
  if (separator == std::string_view::npos) return std::nullopt;
  const auto width = parse_number<int>(text.substr(0, separator));
  const auto height = parse_number<int>(text.substr(separator + 1));
  if (!width || !height) return std::nullopt;
  return PixelSize{*width, *height};
}

CLI::Validator count_between(std::uint64_t lowest, std::uint64_t highest) {
  return within(WholeNumbers{lowest, highest});
}

CLI::Validator share_up_to(double highest) {
  const auto check = [=](std::string& text) -> std::string {
    const auto share = parse_share(text);
    if (!share || *share > highest) {
      return fmt::format("'{}' is not a fraction above 0, up to {:.0f}%, such as 2% or 0.02", text,
                         100 * highest);
    }
    text = fmt::format("{}", *share);
    return {};
  };
  return {check, ""};
}

CLI::Validator duration() {
  const auto check = [](std::string& text) -> std::string {
    const auto seconds = parse_duration(text);
    if (!seconds) return fmt::format("'{}' is not a time such as 33ms or 2s", text);
    text = fmt::format("{}", *seconds);
    return {};
  };
  return {check, ""};
}

CLI::Validator number_between(double lowest, double highest) {
  return within(Numbers{lowest, highest});
}

CLI::Validator positive_number() { return within(PositiveNumbers{}); }

std::optional<SettingValue> parse_value(std::string_view text, const ValueRange& range) {
  const auto as_value = [](const auto& parsed) {
    return parsed ? std::optional<SettingValue>(*parsed) : std::nullopt;
  };
  const std::optional<SettingValue> value =
      std::holds_alternative<WholeNumbers>(range) ? as_value(parse_count(text))
      : std::holds_alternative<Words>(range) || std::holds_alternative<Text>(range)
          ? std::optional<SettingValue>(text)
          : as_value(parse_number<double>(text));
  return value && contains(range, *value) ? value : std::nullopt;
}

CLI::Validator within(const ValueRange& range) {
  const auto check = [=](std::string& text) -> std::string {
    const auto value = parse_value(text, range);
    if (!value) return out_of_range(text, range);
    if (std::holds_alternative<WholeNumbers>(range)) text = text_of(*value);
    return {};
  };
  return {check, ""};
}

CLI::Validator picture_size() {
  const auto check = [](std::string& text) -> std::string {
    const auto size = parse_size(text);
    const auto fits = [](int side) { return side >= 1 && side <= limits::max_image_side; };
    if (!size || !fits(size->width) || !fits(size->height)) {
      return fmt::format("'{}' is not WIDTHxHEIGHT with sides from 1 to {}", text,
                         limits::max_image_side);
    }
    return {};
  };
  return {check, ""};
}

CLI::Validator frame_range() {
  const auto check = [](std::string& text) -> std::string {
    if (walk::parse_frame_range(text)) return {};
    return fmt::format("'{}' is not A, A-B or A-BxS, such as 1-240x10", text);
  };
  return {check, ""};
}

CLI::Validator file_ending_in(std::vector<std::string> endings) {
  const auto check = [endings = std::move(endings)](std::string& file) -> std::string {
    for (const std::string& ending : endings) {
      if (ends_in(file, ending)) return {};
    }
    return fmt::format("'{}' does not end in {}; rename it", file, fmt::join(endings, " or "));
  };
  return {check, ""};
}

}  // namespace photile::app
