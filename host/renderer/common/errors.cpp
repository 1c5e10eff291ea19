#include "photile/errors.hpp"

#include "common/foreign_text.hpp"
#include "photile/progress.hpp"

namespace photile {

Error::Error(const std::string& message) : std::runtime_error(one_line(message)) {}

void Progress::begin(std::string_view, std::uint64_t, std::string_view) {}
void Progress::advance(std::uint64_t) {}
void Progress::end() {}
void Progress::note(const std::string&) {}
void Progress::warn(const std::string& line) { note("warning: " + line); }
bool Progress::cancelled() const { return false; }

void Progress::throw_if_cancelled() const {
  if (cancelled()) throw Interrupted();
}

Progress& Progress::none() {
  static Progress ignoring;
  return ignoring;
}

}  // namespace photile
