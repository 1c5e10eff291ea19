#include "device/warning.hpp"

#include <cstdio>

namespace photile::device {

void warn(const std::string& line) {
  // One call, so that the lines of several processes do not mix.
  const std::string text = "photile: warning: " + line + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace photile::device
