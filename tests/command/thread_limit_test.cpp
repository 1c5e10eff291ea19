// --threads: how many threads work on the host.
#include <stdlib.h>
#include <tbb/global_control.h>

#include <catch2/catch.hpp>

#include "command/processes.hpp"

namespace photile::test {
namespace {

std::size_t allowed() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace

TEST_CASE("while a limit of threads lives, TBB keeps to it") {
  const std::size_t before = allowed();
  for (const int count : {1, 2, 3}) {
    const app::ThreadLimit limit(count);
    CHECK(allowed() == static_cast<std::size_t>(count));
  }
  CHECK(allowed() == before);
  const app::ThreadLimit none(0);
  CHECK(allowed() == before);
  for (const char* variable : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
    ::unsetenv(variable);  // those of the tests that follow
  }
}

}  // namespace photile::test
