#include "photile/progress.hpp"

#include "photile/errors.hpp"

namespace photile {

void Progress::begin(std::string_view, std::uint64_t, std::string_view) {}
void Progress::advance(std::uint64_t) {}
void Progress::end() {}
void Progress::note(const std::string&) {}
bool Progress::cancelled() const { return false; }

void Progress::throw_if_cancelled() const {
  if (cancelled()) throw Interrupted();
}

Progress& Progress::none() {
  static Progress ignoring;
  return ignoring;
}

}  // namespace photile
