// Numbers in the text of photometric files, whatever the locale says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/ascii_text.hpp"

namespace photile::photometry {

/// Reads numbers separated by blanks, commas or ends of lines.
class NumberReader {
 public:
  /// `lines` must outlive this; reading starts at line `first`, counted from 0.
  NumberReader(const std::vector<std::string_view>& lines, std::size_t first)
      : lines_(lines), line_(first) {}

  /// Errors: ResourceError that tells `what` is missing, or no number, and in which line.
  double number(const std::string& what);
  /// A whole number in [lowest, highest]. Errors: ResourceError.
  std::size_t count(const std::string& what, std::uint64_t lowest, std::uint64_t highest);
  std::vector<double> numbers(const std::string& what, std::size_t count);

  /// For messages: "line 12".
  std::string place() const;

 private:
  std::string_view token();

  const std::vector<std::string_view>& lines_;
  std::size_t line_;
  std::size_t column_ = 0;
};

}  // namespace photile::photometry
