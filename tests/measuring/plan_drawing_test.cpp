// Plans of planes whose values are known.
#include "report/plan_drawing.hpp"

#include <catch2/catch.hpp>
#include <regex>

#include "report/false_colour.hpp"
#include "report/palette.hpp"
#include "report/plan_lines.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

/// A plane of 3 x 2 cells of a metre; of 5 values, one of them is without a sensor.
GridValues plane(const std::string& name, const std::vector<float>& lux) {
  PlaneLayout layout;
  layout.u = {3, 0, 0};
  layout.v = {0, 2, 0};
  layout.columns = 3;
  layout.rows = 2;
  layout.cells = {0, 1, 2, 3, 4, 5};
  if (lux.size() == 5) layout.cells.erase(layout.cells.begin() + 4);
  GridValues values;
  values.grid = grid_on_plane(name, layout);
  const std::vector<std::vector<float>> repeats(2, lux);
  values.lights.push_back({"", means_of(repeats), statistics_of(repeats, 0, lux.size())});
  return values;
}

std::string plan(const GridValues& values, const report::FalseColour& options) {
  return report::plan_svg(values, values.total(), options);
}

/// What the pattern's first group matches, each time.
std::vector<std::string> all(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) {
    found.push_back((*i)[1]);
  }
  return found;
}

constexpr double begin = 58, metre = 160;  // pixels of the plane's plan

/// Whether a path has all its corners at this x, in pixels.
void check_runs_at(const std::string& path, double x) {
  const auto corners = all(path, "[ML]([0-9.]+) ");
  REQUIRE(corners.size() >= 2);
  for (const std::string& corner : corners) CHECK(std::stod(corner) == Approx(x).margin(0.01));
}

}  // namespace

TEST_CASE("each cell has the colour of its value, and its number") {
  const std::vector<float> lux{50, 100, 150, 200, 1000};
  const std::string svg = plan(plane("desk", lux), {.scale = 200});
  const report::Palette palette("turbo");
  std::vector<std::string> expected;
  for (const float value : lux) {
    expected.push_back(palette.hex(static_cast<double>(value) / 200));
  }
  CHECK(all(svg, "fill=\"(#[0-9a-f]+)\" shape-rendering") == expected);
  CHECK(all(svg, "font-size=\"9\"[^>]*>([^<]*)<") ==
        std::vector<std::string>{"50", "100", "150", "200", "1000"});
}

TEST_CASE("the legend has the middles of its steps, the label and the plane's name") {
  const std::string svg = plan(plane("a <desk> & \"more\"", {1, 2, 3, 4, 5}),
                               {.scale = 200, .label = "lux", .steps = 4});
  CHECK_THAT(svg, Catch::Contains("a &lt;desk&gt; &amp; &quot;more&quot;") &&
                      Catch::Contains(">lux</text>"));
  CHECK(all(svg, "<text x=\"[0-9.]+\" y=\"[0-9.]+\">([0-9.]+)</text>") ==
        std::vector<std::string>{"25", "75", "125", "175"});
}

TEST_CASE("the isolines of a slope run where the slope has the steps of the standard") {
  // 100, 200, 300 along u in both rows: 150 lux lie at 1 m of 3, 200 at 1.5 m.
  const GridValues values = plane("slope", {100, 200, 300, 100, 200, 300});
  const std::string svg = plan(values, {.scale = 500, .steps = 1});
  const auto lines = all(svg, "stroke-width=\"1.5\" d=\"([^\"]*)\"");
  REQUIRE(lines.size() == 2);
  // Four pixels a millimetre: at 1:25 a metre is 40 mm. Two rows of dimensions stand on the left.
  CHECK_THAT(svg, Catch::Contains("slope, 1:25<") && Catch::Contains(">3.00</text>"));
  check_runs_at(lines[0], begin + 1.0 * metre);
  check_runs_at(lines[1], begin + 1.5 * metre);
}

TEST_CASE("a plan has the largest of the draughtsmen's scales at which it fits on a page") {
  GridValues values = plane("hall", {1, 2, 3, 4, 5, 6});
  const auto scale_of = [&](double width, double depth) {
    values.grid.layout->u = {width, 0, 0};
    values.grid.layout->v = {0, depth, 0};
    const std::string svg = plan(values, {});
    const double wide = std::stod(all(svg, "width=\"([0-9.]+)mm\"").front());
    const double high = std::stod(all(svg, "height=\"([0-9.]+)mm\"").front());
    CHECK(wide <= 180);
    CHECK(high <= 190);
    return all(svg, "hall, 1:([0-9.]+)<").front();
  };
  CHECK(scale_of(6, 5) == "50");   // 120 mm of 130
  CHECK(scale_of(7, 5) == "75");   // 140 mm would not fit
  CHECK(scale_of(4, 11) == "75");  // by its height
  CHECK(scale_of(120, 80) == "1000");
}

TEST_CASE("isolines alone lie in the middles of the legend's steps") {
  const GridValues values = plane("slope", {100, 200, 300, 100, 200, 300});
  const std::string svg =
      plan(values, {.scale = 500, .steps = 1, .contours = report::Contours::lines});
  const auto lines = all(svg, "stroke-width=\"1.5\" d=\"([^\"]*)\"");
  REQUIRE(lines.size() == 1);  // 250 lux
  check_runs_at(lines[0], begin + 2.0 * metre);
}

TEST_CASE("steps of illuminance are those of EN 12464-1") {
  CHECK(report::illuminance_steps(40, 1200) ==
        std::vector<double>{50, 75, 100, 150, 200, 300, 500, 750, 1000});
  CHECK(report::illuminance_steps(300, 500).empty());
  CHECK(report::illuminance_steps(0, 0).empty());
  CHECK(report::illuminance_steps(0, 1e-3).size() < 20);
}

TEST_CASE("a level has its number beside those of cells, or none") {
  const GridValues values = plane("hill", {200, 100, 100, 100, 100, 100});
  const auto numbers = [&](double level) {  // the middle of the only step
    return all(plan(values, {.scale = 2 * level, .steps = 1, .contours = report::Contours::lines}),
               "font-size=\"11\"[^>]*>([^<]*)<");
  };
  CHECK(numbers(150) == std::vector<std::string>{"150"});
  CHECK(numbers(198).empty());  // 4 pixels from the middle of the first cell
}

TEST_CASE("a narrow plan is as wide as its title") {
  GridValues values =
      plane("a plane with a name that is much longer than it is wide", {1, 2, 3, 4, 5});
  values.grid.layout->u = {0.1, 0, 0};
  const auto width = all(plan(values, {}), "viewBox=\"0 0 ([0-9]+) ");
  REQUIRE_FALSE(width.empty());
  // The narrowest letters of sans-serif fonts are about half as wide as high.
  CHECK(std::stod(width[0]) > 20 + 0.5 * 14 * 55);
}

}  // namespace photile::test
