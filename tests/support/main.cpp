#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "before_exit.hpp"
#include "skipped.hpp"

namespace {

constexpr int some_skipped = 77;  // SKIP_RETURN_CODE of CTest
bool skipped = false;

}  // namespace

void photile::test::skip(const std::string& reason) {
  skipped = true;
  WARN("skipped: " << reason);
}

int main(int argument_count, char* arguments[]) {
  // That many failures, which is more than an exit code should say: 77 of them are no skip.
  const int failures = Catch::Session().run(argument_count, arguments);
  if (photile::test::before_exit) photile::test::before_exit();
  if (failures != 0) return 1;
  return skipped ? some_skipped : 0;
}
