#include "command/threads.hpp"

#include <tbb/global_control.h>

#include <cstdlib>
#include <string>

namespace photile::app {

struct ThreadLimit::Impl {
  explicit Impl(int count)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

  /// Made in its place: TBB knows it by its address, and a copy would limit nothing.
  const tbb::global_control control;
};

ThreadLimit::ThreadLimit(int count) {
  if (count == 0) return;
  impl_ = std::make_unique<Impl>(count);
  // What the user set in the environment stays. PoCL before 4 knows the first name, later ones the
  // second.
  for (const char* variable : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
    setenv(variable, std::to_string(count).c_str(), 0);
  }
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace photile::app
