#include "photile/errors.hpp"

#include "common/ascii_text.hpp"

namespace photile {

Error::Error(const std::string& message) : std::runtime_error(one_line(message)) {}

}  // namespace photile
