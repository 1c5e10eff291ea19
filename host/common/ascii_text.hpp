// Text of ASCII letters: its case, and the blanks around it.
#pragma once

#include <string>
#include <string_view>

namespace photile {

/// ASCII letters in lower case.
std::string lower(std::string_view text);

/// Whether a text ends in `ending`, whatever the case of both.
bool ends_in(std::string_view text, std::string_view ending);

/// Without blanks, carriage returns and the Ctrl-Z of old files at either end.
std::string_view trimmed(std::string_view text);

}  // namespace photile
