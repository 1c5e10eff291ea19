// The clear sky against another model, and its table by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "weather/perez_sky.hpp"

namespace photile::test {

using weather::clear_sky;

namespace {
constexpr double degree = std::numbers::pi / 180;
}

TEST_CASE("a clear sky is that of the table on the 21sts") {
  const auto june = clear_sky(30 * degree, 172);
  CHECK(june.direct_normal == Approx(1092 * std::exp(-0.185 / 0.5)));
  CHECK(june.diffuse_horizontal == Approx(0.137 * june.direct_normal));
  const auto january = clear_sky(90 * degree, 21);
  CHECK(january.direct_normal == Approx(1202 * std::exp(-0.141)));
  CHECK(clear_sky(-0.01, 172).direct_normal == 0);
  CHECK(clear_sky(0, 172).diffuse_horizontal == 0);
}

TEST_CASE("days between are between, the turn of the year too") {
  for (int day = 1; day < 365; ++day) {
    const double today = clear_sky(0.7, day).direct_normal;
    CHECK(std::abs(clear_sky(0.7, day + 1).direct_normal - today) < 3);
  }
  CHECK(clear_sky(0.7, 1).direct_normal ==
        Approx(clear_sky(0.7, 365).direct_normal).epsilon(0.005));
}

TEST_CASE("a clear sky gives open ground what Haurwitz measured, within 12%") {
  // Haurwitz, Insolation in relation to cloudiness and cloud density, J. Meteorology 2, 1945.
  for (const int day : {21, 80, 172, 264, 355}) {
    for (double elevation = 15; elevation <= 85; elevation += 10) {
      const double sine = std::sin(elevation * degree);
      const double measured = 1098 * sine * std::exp(-0.057 / sine);
      const auto sky = clear_sky(elevation * degree, day);
      CHECK(sky.direct_normal * sine + sky.diffuse_horizontal == Approx(measured).epsilon(0.12));
    }
  }
}

}  // namespace photile::test
