// Launches cut by their measured time.
#include <catch2/catch.hpp>

#include "device/launch.hpp"

namespace photile::test {

using device::next_launch;

TEST_CASE("the next launch takes a tenth of a second at the speed of the last") {
  CHECK(next_launch(100'000, 0.1) == 100'000);
  CHECK(next_launch(100'000, 0.4) == 25'000);
  CHECK(next_launch(100'000, 0.05) == 200'000);
}

TEST_CASE("launches grow four times at most, and never to nothing") {
  CHECK(next_launch(16'384, 1e-6) == 4 * 16'384);
  CHECK(next_launch(16'384, 0) == 4 * 16'384);
  CHECK(next_launch(16'384, 1e6) == 1024);
  CHECK(next_launch(1u << 30, 1e-6) == 1u << 30);
}

TEST_CASE("whatever the speed of a device, launches come to keep below a fifth of a second") {
  for (const double items_per_second : {2e4, 1e6, 1e9}) {
    std::uint32_t items = 1u << 14;
    for (int launch = 0; launch < 20; ++launch)
      items = next_launch(items, items / items_per_second);
    CHECK(items / items_per_second < 0.2);
  }
}

}  // namespace photile::test
