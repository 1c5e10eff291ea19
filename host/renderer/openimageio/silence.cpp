#include "openimageio/silence.hpp"

#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace photile::openimageio {
namespace {

thread_local int silences = 0;  ///< of this thread

/// A stream that drops what a silent thread prints and hands on the rest.
std::FILE* filter() {
  static std::FILE* const stream = [] {
    cookie_io_functions_t functions{};
    functions.write = [](void*, const char* text, std::size_t size) {
      return silences > 0 ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
    };
    std::FILE* const opened = fopencookie(nullptr, "w", functions);
    if (opened != nullptr) std::setvbuf(opened, nullptr, _IONBF, 0);
    return opened;
  }();
  return stream;
}

std::mutex mutex;
int silent_threads = 0;
std::FILE* standard_error = nullptr;  ///< while threads are silent

}  // namespace

Silence::Silence() {
  if (silences++ > 0) return;
  const std::lock_guard lock(mutex);
  if (silent_threads++ > 0 || filter() == nullptr) return;
  standard_error = stderr;
  stderr = filter();
}

Silence::~Silence() {
  if (--silences > 0) return;
  const std::lock_guard lock(mutex);
  if (--silent_threads > 0 || filter() == nullptr) return;
  stderr = standard_error;
}

}  // namespace photile::openimageio
