// Text without the blanks around it.
#pragma once

#include <string_view>

namespace photile::scene_io {

/// Without blanks, carriage returns and the Ctrl-Z of old files at either end.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\f\v\x1A";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace photile::scene_io
