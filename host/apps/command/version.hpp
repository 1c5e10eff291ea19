// What `photile --version` prints.
#pragma once

#include <string>

namespace photile::app {

/// "0.1.0"
std::string version_number();

/// One line for photile and its commit, one for each thing it was built with.
std::string version_text();

}  // namespace photile::app
