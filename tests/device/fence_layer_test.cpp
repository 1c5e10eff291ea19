#include <catch2/catch.hpp>
#include <csignal>

#include "child_process.hpp"

namespace photile::test {
namespace {

ChildResult probe(const char* mode, bool fence) {
  // The address sanitizer would turn the signal into an exit code of its own. Leaks are not the
  // subject here.
  ChildEnvironment environment = {{"ASAN_OPTIONS", "handle_segv=0:detect_leaks=0"}};
  if (fence) environment["OPENCL_LAYERS"] = PHOTILE_FENCE_LAYER;
  return run_child({PHOTILE_DEVICE_PROBE, mode}, environment);
}

}  // namespace

TEST_CASE("a correct kernel gives the same results behind the fence") {
  const auto plain = probe("run", false);
  const auto fenced = probe("run", true);
  INFO(plain.errors << fenced.errors);
  CHECK(plain.exit_code == 0);
  CHECK(fenced.exit_code == 0);
  // The sum of i^2 for i < 1000 is 999 * 1000 * 1999 / 6.
  CHECK_THAT(plain.output, Catch::Contains("last=998001 sum=332833500"));
  CHECK_THAT(fenced.output, Catch::Contains("last=998001 sum=332833500"));
}

TEST_CASE("a kernel that writes one element past the end dies at the fence") {
  CHECK(probe("overrun", true).signal == SIGSEGV);
}

TEST_CASE("what no kernel wrote shows behind the fence") {
  CHECK_THAT(probe("unwritten", true).output, Catch::Contains("last=-1 "));
}

}  // namespace photile::test
