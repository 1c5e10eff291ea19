// Plans of a room.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "image/display.hpp"
#include "measuring/floor.hpp"
#include "measuring/working_plane.hpp"
#include "photile/errors.hpp"
#include "report/false_colour.hpp"
#include "report/palette.hpp"
#include "report/plan_drawing.hpp"
#include "report/plan_lines.hpp"
#include "report/sheet.hpp"
#include "report/tables.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using namespace photile::measuring;

// Plans of planes whose values are known.

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

/// Whether a path has all its corners at this x, in pixels.
void check_runs_at(const std::string& path, double x) {
  const auto corners = all(path, "[ML]([0-9.]+) ");
  REQUIRE(corners.size() >= 2);
  for (const std::string& corner : corners) CHECK(std::stod(corner) == Approx(x).margin(0.01));
}

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
  CHECK_THAT(
      svg, Catch::Contains("a &lt;desk> &amp; &quot;more&quot;") && Catch::Contains(">lux</text>"));
  CHECK(all(svg, "<text x=\"[0-9.]+\" y=\"[0-9.]+\">([0-9.]+)</text>") ==
        std::vector<std::string>{"25", "75", "125", "175"});
}

TEST_CASE("the isolines of a slope run where the slope has the steps of the standard") {
  // 100, 200, 300 along u in both rows: 150 lux lie at 1 m of 3, 200 at 1.5 m.
  const GridValues values = plane("slope", {100, 200, 300, 100, 200, 300});
  const std::string svg = plan(values, {.scale = 500, .steps = 1});
  const auto lines = all(svg, "stroke-width=\"1.5\" d=\"([^\"]*)\"");
  REQUIRE(lines.size() == 2);
  // The plan is 560 pixels wide and begins at 20.
  check_runs_at(lines[0], 20 + 1.0 / 3 * 560);
  check_runs_at(lines[1], 20 + 1.5 / 3 * 560);
}

TEST_CASE("isolines alone lie in the middles of the legend's steps") {
  const GridValues values = plane("slope", {100, 200, 300, 100, 200, 300});
  const std::string svg =
      plan(values, {.scale = 500, .steps = 1, .contours = report::Contours::lines});
  const auto lines = all(svg, "stroke-width=\"1.5\" d=\"([^\"]*)\"");
  REQUIRE(lines.size() == 1);  // 250 lux
  check_runs_at(lines[0], 20 + 2.0 / 3 * 560);
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
  const auto width = all(plan(values, {}), "width=\"([0-9]+)\" height");
  REQUIRE_FALSE(width.empty());
  // The narrowest letters of sans-serif fonts are about half as wide as high.
  CHECK(std::stod(width[0]) > 20 + 0.5 * 14 * 55);
}

// Walls, furniture and lamps on plans, of a room that is known.

/// A room of 4 x 6 m with a table, x from 1 to 2, z from 2 to 3, whose top lies at 0.7 m, and a
/// lamp over it.
Scene room() {
  test::SceneBuilder builder("room");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({1, 0.65f, 2}, {2, 0.70f, 3}, white, false);
  builder.add(test::point_light("lamp", {1.5f, 2.2f, 2.5f}));
  return builder.build();
}

/// A plane of 3 x 5 cells of a metre that begins at (0.5, 0.75, 5.5).
PlaneLayout layout() {
  PlaneLayout layout;
  layout.origin = {0.5, 0.75, 5.5};
  layout.u = {3, 0, 0};
  layout.v = {0, 0, -5};
  layout.columns = 3;
  layout.rows = 5;
  return layout;
}

/// x and z of a place in cells.
glm::dvec2 world(const glm::dvec2& cells) { return {0.5 + cells.x, 5.5 - cells.y}; }

double length_of(const std::vector<report::Segment>& segments) {
  double length = 0;
  for (const report::Segment& segment : segments) length += glm::distance(segment[0], segment[1]);
  return length;
}

TEST_CASE("a plan's walls are where its plane cuts the room") {
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, layout());
  CHECK(around.reach >= 0.5);
  CHECK(length_of(around.walls) == Approx(20));  // 2 x (4 + 6) m
  for (const report::Segment& segment : around.walls) {
    for (const glm::dvec2& end : segment) {
      const glm::dvec2 at = world(end);
      const double from_wall =
          std::min({std::abs(at.x), std::abs(at.x - 4), std::abs(at.y), std::abs(at.y - 6)});
      CHECK(from_wall < 1e-5);
    }
  }
}

TEST_CASE("a plan's furniture is outlined where it stands, and its lamps have their numbers") {
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, layout());
  REQUIRE_FALSE(around.furniture.empty());
  glm::dvec2 low(100.0), high(-100.0);
  for (const report::Segment& segment : around.furniture) {
    for (const glm::dvec2& end : segment) {
      const glm::dvec2 at = world(end);
      if (at.x < 0.05 || at.x > 3.95 || at.y < 0.05 || at.y > 5.95) continue;  // walls
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  }
  // Rays are 7 m / 300 apart.
  CHECK(glm::distance(low, glm::dvec2(1, 2)) < 0.04);
  CHECK(glm::distance(high, glm::dvec2(2, 3)) < 0.04);
  REQUIRE(around.lamps.size() == 1);
  CHECK(around.lamps[0].number == 1);
  CHECK(glm::distance(world(around.lamps[0].place), glm::dvec2(1.5, 2.5)) < 1e-6);
}

TEST_CASE("what does not lie flat has no surroundings") {
  PlaneLayout wall = layout();
  wall.v = {0, 1, 0};
  const Scene scene = room();
  const RayScene rays(scene);
  const report::PlanSurroundings around = report::surroundings_of(rays, wall);
  CHECK(around.reach == 0);
  CHECK(around.walls.empty());
}

// Points in furniture are left out of grids.

/// A room of 4 x 6 m with a table, x from 1 to 2, whose top lies at 0.70 to 0.74 m; a solid
/// cupboard, x from 3 to 3.92, 2 m high, `inwards` if it is wound inside out; a single sheet under
/// the ceiling, z from 3 on.
Scene furnished(bool inwards) {
  test::SceneBuilder builder("room");
  const auto white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box({0, 0, 0}, {4, 2.5f, 6}, white, true);
  builder.box({1, 0.70f, 0.4f}, {2, 0.74f, 5.6f}, white, false);
  builder.box({3, 0.01f, 0.4f}, {3.92f, 2, 5.6f}, white, inwards);
  builder.quad({0.5f, 2.4f, 3}, {3.5f, 2.4f, 3}, {3.5f, 2.4f, 5.9f}, {0.5f, 2.4f, 5.9f}, white);
  builder.add(test::point_light("lamp", {2.5f, 2.2f, 3}));
  return builder.build();
}

SensorGrid plane_at(const Scene& scene, const char* height) {
  WorkingPlane plane = parse_working_plane(height);
  plane.spacing = 0.2;
  return working_plane_grid(scene, plane);
}

TEST_CASE("points in a solid, or nearer to a surface than the clearance, are left out") {
  const Scene scene = furnished(GENERATE(false, true));
  SensorGrid grid = plane_at(scene, "floor+0.8");
  const std::vector<Sensor> all = grid.sensors;
  std::size_t expected = 0;
  const auto stays = [](const glm::dvec3& at) {
    const bool along = at.z > 0.4 && at.z < 5.6;
    return !(along && ((at.x > 1 && at.x < 2) || (at.x > 3 && at.x < 3.92)));
  };
  for (const Sensor& sensor : all) expected += stays(sensor.position) ? 0 : 1;
  REQUIRE(expected > 100);
  CHECK(leave_out_furniture(scene, 0.1, grid) == expected);
  for (const Sensor& sensor : grid.sensors) CHECK(stays(sensor.position));
  REQUIRE(grid.layout);
  REQUIRE(grid.layout->cells.size() == grid.sensors.size());
  for (std::size_t i = 0; i < grid.sensors.size(); ++i) {
    CHECK(glm::distance(grid.layout->middle_of(grid.layout->cells[i]), grid.sensors[i].position) <
          1e-9);
  }
}

TEST_CASE("a table that is farther away than the clearance leaves its points in") {
  const Scene scene = furnished(false);
  SensorGrid grid = plane_at(scene, "floor+0.8");
  const std::size_t all = grid.sensors.size();
  const std::size_t left_out = leave_out_furniture(scene, 0.03, grid);  // the cupboard alone
  std::size_t over_table = 0;
  for (const Sensor& sensor : grid.sensors) {
    const glm::dvec3& at = sensor.position;
    over_table += at.x > 1 && at.x < 2 && at.z > 0.4 && at.z < 5.6 ? 1 : 0;
  }
  CHECK(over_table > 50);
  CHECK(left_out > 50);
  CHECK(left_out + grid.sensors.size() == all);
}

// Isolines against straight lines and circles, and the colours of values.

template <class F>
std::vector<double> field(int columns, int rows, const F& value) {
  std::vector<double> values;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) values.push_back(value(x + 0.5, y + 0.5));
  }
  return values;
}

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

TEST_CASE("the isoband of a slope has the area between its isolines") {
  const auto values = field(6, 5, [](double x, double) { return x; });
  double area = 0;
  for (const report::Polygon& polygon : report::isoband(values, 6, 5, 1.7, 3.2)) {
    double twice = 0;  // shoelace formula
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      twice += a.x * b.y - b.x * a.y;
      CHECK(a.x == Approx(std::clamp(a.x, 1.7, 3.2)));
    }
    area += std::abs(twice) / 2;
  }
  CHECK(area == Approx(1.5 * 4));  // between the middles of the first and the last row
}

TEST_CASE("the isoband of a hill is a ring, whole where all is inside, gone where nothing is") {
  const auto values =
      field(80, 80, [](double x, double y) { return 100 - std::hypot(x - 40, y - 40); });
  const auto area = [&](double low, double high) {
    double sum = 0;
    for (const report::Polygon& polygon : report::isoband(values, 80, 80, low, high)) {
      double twice = 0;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - b.x * a.y;
      }
      sum += std::abs(twice) / 2;
    }
    return sum;
  };
  CHECK(area(70, 80) == Approx(3.14159265 * (30 * 30 - 20 * 20)).epsilon(0.002));
  CHECK(area(0, 200) == Approx(79 * 79));
  CHECK(area(150, 200) == 0);
}

TEST_CASE("bands are the middle fifth of each step, and posterized values have its colour") {
  const report::ColourScale bands({.contours = report::Contours::bands}, 0);  // 8 steps of 125
  CHECK(bands.bands()[2][0] == Approx(2.4 * 125));
  CHECK(bands.bands()[2][1] == Approx(2.6 * 125));
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

TEST_CASE("values beyond the scale have the colours of its ends, unknown palettes are refused") {
  const report::ColourScale scale({.palette = "viridis"}, 0);
  CHECK(scale.hex(5000) == scale.hex(1000));
  CHECK(scale.hex(-5) == scale.hex(0));
  CHECK(scale.hex(0) == "#440154");  // viridis begins and ends so (van der Walt and Smith, 2015)
  CHECK(scale.hex(1000) == "#fde725");
  CHECK_THROWS_AS(report::ColourScale({.palette = "rainbow"}, 0), UsageError);
}

// Pictures in false colour: known lux and cd/m2 in known colours.

using Colour = std::array<std::uint8_t, 3>;

/// Two pixels, two lights at power 1: lux (or W/m2) 3 and 0 by the first, 1 and 2 by the second.
LightLayers two_pixels() {
  LightLayers layers(2, 1, {"a", "b"});
  layers.layers[0].radiance = {glm::vec3(1), glm::vec3(0)};
  layers.layers[0].illuminance = {3, 0};
  layers.layers[1].radiance = {glm::vec3(0.5f), glm::vec3(0, 2, 0)};
  layers.layers[1].illuminance = {1, 2};
  return layers;
}

LightMix mix_of(double a, double b, PowerUnit unit = PowerUnit::lumen) {
  LightMix mix;
  mix.lights.resize(2);
  mix.lights[0].name = "a";
  mix.lights[0].power = a;
  mix.lights[1].name = "b";
  mix.lights[1].power = b;
  for (MixedLight& light : mix.lights) light.unit = unit;
  return mix;
}

/// A black picture.
Image black(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* channel : {"R", "G", "B"}) image.add(channel);
  return image;
}

Colour colour_at(const Image& picture, int x, int y) {
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = image::srgb8_from_linear(
        picture.channels[c][static_cast<std::size_t>(y * picture.width + x)]);
  }
  return colour;
}

TEST_CASE("the illuminance of a picture is the sum of its lights' lux") {
  const LightLayers layers = two_pixels();
  CHECK(report::illuminance_of(*mixed_picture(layers, mix_of(10, 100))) ==
        std::vector<float>{130, 200});
  LightMix watts = mix_of(10, 100, PowerUnit::watt);
  watts.lumen_per_watt = 179;
  CHECK(report::illuminance_of(*mixed_picture(layers, watts)) ==
        std::vector<float>{130 * 179, 200 * 179});
}

TEST_CASE("illuminance is read whole where a picture has more rows than are read at a time") {
  constexpr int height = 150;
  LightLayers layers(1, height, {"a", "b"});
  std::vector<float> expected;
  for (int y = 0; y < height; ++y) {
    layers.layers[0].illuminance[static_cast<std::size_t>(y)] = static_cast<float>(y);
    layers.layers[1].illuminance[static_cast<std::size_t>(y)] = 1000;
    expected.push_back(static_cast<float>(1000 + y));
  }
  CHECK(report::illuminance_of(*mixed_picture(layers, mix_of(1, 1))) == expected);
}

TEST_CASE("the luminance of a picture is in cd/m2, of watts by their efficacy") {
  const LightLayers layers = two_pixels();
  // The second pixel: 100 x (0, 2, 0), of which Rec.709's green weighs 0.7152.
  const auto lumens = report::luminance_of(mixed_picture(layers, mix_of(10, 100))->root());
  CHECK(lumens[0] == Approx(60));
  CHECK(lumens[1] == Approx(200 * 0.7152));
  LightMix mix = mix_of(10, 100, PowerUnit::watt);
  mix.lumen_per_watt = 179;
  const auto watts = report::luminance_of(mixed_picture(layers, mix)->root());
  CHECK(watts[0] == Approx(60 * 179));
  CHECK_THROWS_AS(report::luminance_of(black(2, 1)), InputError);  // cd/m2, or what?
}

TEST_CASE("a pixel has the colour that its share of the scale has in the palette") {
  const std::string name = GENERATE("turbo", "def", "viridis");
  const report::Palette palette(name);
  const std::vector<float> lux{0, 125, 250, 500, 499, 5000};
  const Image picture =
      report::false_colour_picture(lux, black(3, 2), {.scale = 500, .palette = name});
  const std::array shares{0.0, 0.25, 0.5, 1.0, 499.0 / 500, 1.0};
  for (int pixel = 0; pixel < 6; ++pixel) {
    INFO("pixel " << pixel);
    CHECK(colour_at(picture, pixel % 3, pixel / 3) ==
          palette.at(shares[static_cast<std::size_t>(pixel)]));
  }
}

TEST_CASE("an automatic scale ends at the largest value that is a number") {
  const std::vector<float> lux{100, 400, std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()};
  const Image picture = report::false_colour_picture(lux, black(4, 1), {.scale = 0});
  const report::Palette palette("turbo");
  CHECK(colour_at(picture, 0, 0) == palette.at(0.25));
  CHECK(colour_at(picture, 1, 0) == palette.at(1));
  CHECK(colour_at(picture, 2, 0) == palette.at(1));
  CHECK(colour_at(picture, 3, 0) == Colour{128, 128, 128});
}

TEST_CASE("a logarithmic scale has its decades below the top") {
  const Image picture =
      report::false_colour_picture(std::vector<float>{10, 100, 1000}, black(3, 1), {.decades = 2});
  const report::Palette palette("turbo");
  CHECK(colour_at(picture, 0, 0) == palette.at(0));
  CHECK(colour_at(picture, 1, 0) == palette.at(0.5));
  CHECK(colour_at(picture, 2, 0) == palette.at(1));
}

TEST_CASE(
    "the legend has a bar for each step, in the colour of its middle, the largest at the top") {
  const int steps = GENERATE(1, 4, 8);
  const std::vector<float> lux(200 * 3, 1);
  const Image picture = report::false_colour_picture(lux, black(3, 200), {.steps = steps});
  CHECK(picture.height == 200);
  const report::Palette palette("turbo");
  constexpr int left = 3 + 12, top = 24;
  for (int step = 0; step < steps; ++step) {
    INFO("step " << step << " of " << steps);
    const double height = (200.0 - top) / steps;
    const int middle = 200 - static_cast<int>((step + 0.5) * height);
    CHECK(colour_at(picture, left, middle) == palette.at((step + 0.5) / steps));
    CHECK(colour_at(picture, left + 19, middle) == palette.at((step + 0.5) / steps));
  }
}

TEST_CASE("beside the legend stand its unit and its values, in a small picture as well") {
  REQUIRE(report::Sheet::has_font());
  const std::vector<float> lux{1};
  const auto drawn = [&](report::FalseColour options) {
    return report::false_colour_picture(lux, black(1, 1), options);
  };
  const Image plain = drawn({});
  CHECK(plain.height >= 8 * report::Sheet::font_size);  // a line for each step
  /// Dark pixels right of the bars, and above them.
  const auto ink = [&](const Image& picture, int first_row, int end_row, int first_column) {
    int count = 0;
    for (int y = first_row; y < end_row; ++y) {
      for (int x = first_column; x < picture.width; ++x) count += colour_at(picture, x, y)[1] < 99;
    }
    return count;
  };
  constexpr int beside = 1 + 12 + 20, top = 24;
  for (int step = 0; step < 8; ++step) {
    CHECK(ink(plain, top + 16 * step, top + 16 * (step + 1), beside) > 10);
  }
  CHECK(ink(plain, 0, top, 1) > 10);
  CHECK(ink(drawn({.label = ""}), 0, top, 1) == 0);
  // The last column is free: nothing is cut off, be the label ever so long.
  for (const std::string label : {"lux", "illuminance of the working plane, lux"}) {
    const Image picture = drawn({.scale = 123456, .label = label});
    CHECK(ink(picture, 0, picture.height, picture.width - 1) == 0);
  }
}

TEST_CASE("isolines lie over the picture") {
  // Levels 250 and 750; a grey picture, 1 x 4 pixels.
  Image grey = black(4, 1);
  for (auto& channel : grey.channels) channel.assign(4, 0.25f);
  const std::vector<float> lux{100, 200, 300, 400};
  const Image picture =
      report::false_colour_picture(lux, grey, {.steps = 2, .contours = report::Contours::lines});
  const Colour background = colour_at(grey, 0, 0);
  CHECK(colour_at(picture, 0, 0) == background);
  CHECK(colour_at(picture, 1, 0) == report::Palette("turbo").at(0.2));  // 250 lies right of it
  CHECK(colour_at(picture, 2, 0) == background);
  CHECK(colour_at(picture, 3, 0) == background);
}

TEST_CASE("numbers of legends and plans have no powers of ten up to a thousand million") {
  CHECK(report::number_text(62.5, 4) == "62.5");
  CHECK(report::number_text(12500, 4) == "12500");
  CHECK(report::number_text(999.6, 3) == "1000");
  CHECK(report::number_text(1234.5, 3) == "1234");
  CHECK(report::number_text(0.06254, 3) == "0.0625");
  CHECK(report::number_text(0, 3) == "0");
  CHECK(report::number_text(3e12, 3) == "3e+12");
}

}  // namespace
}  // namespace photile::test
