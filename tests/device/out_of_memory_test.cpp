#include <catch2/catch.hpp>

#include "device/context.hpp"
#include "device/opencl.hpp"

namespace photile::test {

using photile::device::Context;

TEST_CASE("an absurd allocation says what, how much, the limits and a remedy") {
  Context context({});
  const auto limit = std::to_string(context.info().max_allocation_bytes);
  try {
    context.allocate<float>(1ull << 50, "photon references");
    FAIL("allocated");
  } catch (const photile::DeviceError& error) {
    CHECK_THAT(error.what(), Catch::Contains("photon references"));
    CHECK_THAT(error.what(), Catch::Contains("1125899906842624 x 4 bytes"));
    CHECK_THAT(error.what(), Catch::Contains(limit));
    CHECK_THAT(error.what(), Catch::Contains("fewer photons"));
    CHECK(error.status == -61);  // CL_INVALID_BUFFER_SIZE
  }
  CHECK(context.allocated_bytes() == 0);
}

TEST_CASE("a size whose bytes overflow 64 bits is refused, not wrapped") {
  Context context({});
  CHECK_THROWS_AS(context.allocate<double>(1ull << 62, "wrap"), photile::DeviceError);
}

TEST_CASE("status codes have names") {
  using photile::device::status_name;
  CHECK(status_name(0) == "CL_SUCCESS (0)");
  CHECK(status_name(-5) == "CL_OUT_OF_RESOURCES (-5)");
  CHECK(status_name(-1001) == "CL_PLATFORM_NOT_FOUND_KHR (-1001)");
  CHECK(status_name(-4321) == "unknown status (-4321)");
}

}  // namespace photile::test
