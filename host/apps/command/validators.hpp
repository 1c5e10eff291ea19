// Checks of option values. Each also rewrites the text into what CLI11 converts to the option's
// type, and names the range in the help and in the refusal.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/value_range.hpp"

namespace photile::app {

/// A whole number: "500000", "5e5", "500k", "0.5M", "1G". Nothing if it is none, or beyond 64 bits.
std::optional<std::uint64_t> parse_count(std::string_view text);

/// A part of a whole above 0: "2%", "0.02". Nothing if it is none.
std::optional<double> parse_share(std::string_view text);

/// A time above 0 in seconds: "33ms", "1.5s", "2min". Nothing if it is none or has no unit.
std::optional<double> parse_duration(std::string_view text);

struct PixelSize {
  int width = 0, height = 0;
};

/// "640x480". Nothing if it is none.
std::optional<PixelSize> parse_size(std::string_view text);

/// A value in the range: a whole number as `parse_count` reads it, a finite number, a word, which
/// then is a view of `text`. Nothing if it is none.
std::optional<SettingValue> parse_value(std::string_view text, const ValueRange& range);

/// A value in the range.
CLI::Validator within(const ValueRange& range);

/// A count as `parse_count` reads it, in [lowest, highest].
CLI::Validator count_between(std::uint64_t lowest, std::uint64_t highest);

/// A share as `parse_share` reads it, at most `highest`.
CLI::Validator share_up_to(double highest);

/// A time as `parse_duration` reads it.
CLI::Validator duration();

/// A finite number in [lowest, highest].
CLI::Validator number_between(double lowest, double highest);

/// A finite number greater than zero.
CLI::Validator positive_number();

/// Frames as walk::parse_frame_range reads them.
CLI::Validator frame_range();

/// A size as `parse_size` reads it, within the limits of pictures.
CLI::Validator picture_size();

/// The name of a file that ends in one of these, in small letters or capitals.
///   endings   ".png", ...
CLI::Validator file_ending_in(std::vector<std::string> endings);

}  // namespace photile::app
