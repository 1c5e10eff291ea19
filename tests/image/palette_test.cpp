// The palettes of Radiance's falsecolor, from its formulas and tables.
#include "report/palette.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace photile::test {

using namespace photile::report;

namespace {

void check_near(const glm::dvec3& is, double r, double g, double b) {
  CHECK(is.r == Approx(r).margin(1e-6));
  CHECK(is.g == Approx(g).margin(1e-6));
  CHECK(is.b == Approx(b).margin(1e-6));
}

}  // namespace

TEST_CASE("Radiance's palettes have its colours") {
  // Ends and an entry of the table in def: 0.0454545 x 10.
  check_near(report::radiance_palette("def", 0), 0.18848, 0.0009766, 0.2666);
  check_near(report::radiance_palette("def", 0.454545), 0.1739422, 0.2629843, 0.08564082);
  check_near(report::radiance_palette("def", 0.5 * 0.0454545), (0.18848 + 0.05468174) / 2,
             (0.0009766 + 2.35501e-05) / 2, (0.2666 + 0.3638662) / 2);
  // spec: 1.6 x - 0.6, clipped; both branches of green meet at 0.375.
  check_near(report::radiance_palette("spec", 0), 0, 0, 1);
  check_near(report::radiance_palette("spec", 0.375), 0, 1, 0);
  check_near(report::radiance_palette("spec", 1), 1, 0, 0);
  // The others are sRGB-like values to the power of 2.2.
  check_near(report::radiance_palette("pm3d", 0.25), std::pow(0.5, 2.2), std::pow(1.0 / 64, 2.2),
             1);
  check_near(report::radiance_palette("hot", 0.5), 1, std::pow(0.5, 2.2), 0);
  check_near(report::radiance_palette("eco", 0.25), std::pow(0.5, 2.2), 0, std::pow(0.5, 2.2));
}

TEST_CASE("every palette that is named can be used") {
  for (const std::string& name : report::Palette::names()) {
    INFO(name);
    const report::Palette palette(name);
    CHECK(palette.at(0) != palette.at(1));
  }
  CHECK(report::Palette("hot").hex(1) == "#ffffff");
  CHECK(report::Palette("eco").hex(0) == "#0000ff");
}

}  // namespace photile::test
