// Text whose case does not matter: endings of file names, names of devices.
#pragma once

#include <string>
#include <string_view>

namespace photile {

/// ASCII letters in lower case.
std::string lower(std::string_view text);

/// Whether a text ends in `ending`, whatever the case of both.
bool ends_in(std::string_view text, std::string_view ending);

}  // namespace photile
