// Isolines against straight lines and circles, and the colours of values.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "report/false_colour.hpp"
#include "report/plan_surroundings.hpp"

namespace photile::test {
namespace {

template <class F>
std::vector<double> field(int columns, int rows, const F& value) {
  std::vector<double> values;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) values.push_back(value(x + 0.5, y + 0.5));
  }
  return values;
}

}  // namespace

TEST_CASE("the isoline of a slope is exactly straight") {
  const auto values = field(6, 5, [](double x, double y) { return 2 * x + y; });
  const auto segments = report::isoline(values, 6, 5, 7.3);
  REQUIRE_FALSE(segments.empty());
  for (const report::Segment& segment : segments) {
    for (const glm::dvec2& end : segment) CHECK(2 * end.x + end.y == Approx(7.3));
  }
}

TEST_CASE("the isolines of a hill are closed curves of its circumference") {
  const auto values =
      field(80, 80, [](double x, double y) { return 100 - std::hypot(x - 40, y - 40); });
  double length = 0;
  for (const report::Segment& segment : report::isoline(values, 80, 80, 70)) {
    length += glm::length(segment[1] - segment[0]);
    for (const glm::dvec2& end : segment) {
      CHECK(glm::length(end - glm::dvec2(40)) == Approx(30).epsilon(0.001));
    }
  }
  CHECK(length == Approx(2 * 3.14159265 * 30).epsilon(0.002));
}

TEST_CASE("a saddle is cut by two lines that do not cross, whichever way its middle leans") {
  // Corners low, high, low, high, counter-clockwise; the mean is above, then below the level.
  for (const double level : {4.0, 6.0}) {
    const auto segments = report::isoline(std::vector<double>{0, 10, 10, 0}, 2, 2, level);
    REQUIRE(segments.size() == 2);
    // Above: the low corners (0.5, 0.5) and (1.5, 1.5) are cut off, else the high ones.
    const glm::dvec2 sum = segments[0][0] + segments[0][1];
    const bool along_low_corners = (sum.x < 2) == (sum.y < 2);
    CHECK(along_low_corners == (level < 5));
  }
}

TEST_CASE("cells without a value have no lines") {
  auto values = field(3, 3, [](double x, double) { return x; });
  values[4] = std::numeric_limits<double>::quiet_NaN();
  CHECK(report::isoline(values, 3, 3, 1.2).empty());
}

TEST_CASE("bands are the middle fifth of each step, and posterized values have its colour") {
  const report::ColourScale bands({.contours = report::Contours::bands}, 0);  // 8 steps of 125
  CHECK(bands.in_band(2.5 * 125));
  CHECK_FALSE(bands.in_band(2.39 * 125));
  CHECK_FALSE(bands.in_band(2.61 * 125));
  CHECK_FALSE(bands.in_band(8.5 * 125));  // beyond the scale
  CHECK(bands.levels_below(2.49 * 125) == 2);
  CHECK(bands.levels_below(2.51 * 125) == 3);
  const report::ColourScale steps({.contours = report::Contours::steps}, 0), filled({}, 0);
  CHECK(steps.hex(2.01 * 125) == filled.hex(2.5 * 125));
  CHECK(steps.hex(2.99 * 125) == filled.hex(2.5 * 125));
  CHECK(steps.hex(5000) == filled.hex(7.5 * 125));
}

TEST_CASE("legend steps and isolines lie as in Radiance's falsecolor") {
  CHECK(report::ColourScale({}, 123).top() == 1000);
  const auto levels = report::ColourScale({}, 123).levels();
  REQUIRE(levels.size() == 8);
  CHECK(levels.front() == Approx(62.5));
  CHECK(levels.back() == Approx(937.5));
  CHECK(report::ColourScale({.scale = 0}, 123).top() == 123);
  CHECK(report::ColourScale({.scale = 0}, 0).top() > 0);
  CHECK(report::ColourScale({.decades = 2}, 1).value_at(0) == Approx(10));
  CHECK(report::ColourScale({.decades = 2}, 1).value_at(0.5) == Approx(100));
}

TEST_CASE("values beyond the scale have the colours of its ends") {
  const report::ColourScale scale({.palette = "viridis"}, 0);
  CHECK(scale.hex(5000) == scale.hex(1000));
  CHECK(scale.hex(-5) == scale.hex(0));
  CHECK(scale.hex(0) == "#440154");  // viridis begins and ends so (van der Walt and Smith, 2015)
  CHECK(scale.hex(1000) == "#fde725");
}

}  // namespace photile::test
