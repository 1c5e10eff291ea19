// Checks of option values. Each also rewrites the text into what CLI11 converts to the option's
// type, and names the range in the help and in the refusal.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace photile::app {

/// A whole number: "500000", "5e5", "500k", "0.5M", "1G". Nothing if it is none, or beyond 64 bits.
std::optional<std::uint64_t> parse_count(std::string_view text);

struct PixelSize {
  int width = 0, height = 0;
};

/// "640x480". Nothing if it is none.
std::optional<PixelSize> parse_size(std::string_view text);

/// A count as `parse_count` reads it, in [lowest, highest].
CLI::Validator count_between(std::uint64_t lowest, std::uint64_t highest);

/// A finite number in [lowest, highest].
CLI::Validator number_between(double lowest, double highest);

/// A finite number greater than zero.
CLI::Validator positive_number();

/// A size as `parse_size` reads it, within the limits of pictures.
CLI::Validator picture_size();

}  // namespace photile::app
