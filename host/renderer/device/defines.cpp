#include <fmt/format.h>

#include <cmath>

#include "device/context.hpp"

namespace photile::device {

Defines& Defines::set(std::string name, long long value) {
  entries_.emplace_back(std::move(name), std::to_string(value));
  return *this;
}

Defines& Defines::set(std::string name, double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) {
    throw DeviceError(fmt::format("definition {} = {} is no finite float", name, value));
  }
  // {} gives the shortest digits that read back as the same float.
  std::string literal = fmt::format("{}", single);
  if (literal.find_first_of(".e") == std::string::npos) literal += ".0";
  entries_.emplace_back(std::move(name), literal + "f");
  return *this;
}

Defines& Defines::set(std::string name) {
  entries_.emplace_back(std::move(name), "1");
  return *this;
}

std::string Defines::options() const {
  std::string text;
  for (const auto& [name, value] : entries_) {
    if (!text.empty()) text += ' ';
    text += fmt::format("-D {}={}", name, value);
  }
  return text;
}

}  // namespace photile::device
