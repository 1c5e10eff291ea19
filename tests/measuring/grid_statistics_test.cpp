// Figures of a grid.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "photile/layered_picture.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using namespace photile::measuring;

// Figures of a grid and their errors, against values that are known, and against their own spread.

using Repeats = std::vector<std::vector<float>>;

/// Values 100 + index with normal noise.
Repeats noisy(std::mt19937& random, std::size_t repeats, std::size_t sensors, double slope,
              double noise) {
  std::normal_distribution<double> normal(0, noise);
  Repeats values(repeats);
  for (auto& repeat : values) {
    for (std::size_t i = 0; i < sensors; ++i) {
      repeat.push_back(static_cast<float>(100 + slope * static_cast<double>(i) + normal(random)));
    }
  }
  return values;
}

/// One grid of the sensors of two lights and of both.
Measurement measured(std::vector<double> left, std::vector<double> right) {
  GridValues grid;
  grid.lights.resize(3);
  grid.lights[1].light = "left";
  grid.lights[2].light = "right";
  for (std::size_t i = 0; i < left.size(); ++i) {
    grid.lights[0].sensors.push_back({left[i] + right[i], 0});
    grid.lights[1].sensors.push_back({left[i], 0});
    grid.lights[2].sensors.push_back({right[i], 0});
  }
  return {grid};
}

TEST_CASE(
    "points without light and lights that reach no point are doubted, but not those turned off") {
  std::vector<MixedLight> lights(2);
  lights[0].name = "left";
  lights[1].name = "right";
  lights[0].power = lights[1].power = 1;
  CHECK(doubts_of(measured({3, 1}, {2, 0}), lights).empty());
  const auto dark = doubts_of(measured({3, 0, 0}, {2, 0, 0}), lights);
  REQUIRE(dark.size() == 1);
  CHECK_THAT(dark[0], Contains("2 of 3 points have no light"));
  const auto without_right = doubts_of(measured({3, 1}, {0, 0}), lights);
  REQUIRE(without_right.size() == 1);
  CHECK_THAT(without_right[0], Contains("light 'right' reaches no point"));
  lights[1].power = 0;
  CHECK(doubts_of(measured({3, 1}, {0, 0}), lights).empty());
  // All dark: the likelier mistake.
  const auto all_dark = doubts_of(measured({0, 0}, {0, 0}), lights);
  REQUIRE(all_dark.size() == 2);
  CHECK_THAT(all_dark[0], Contains("none of the 2 points has any light"));
  CHECK_THAT(all_dark[1], Contains("light 'left' reaches no point"));
  lights[0].power = 0;
  const auto off = doubts_of(measured({0, 0}, {0, 0}), lights);
  REQUIRE(off.size() == 1);
  CHECK_THAT(off[0], Contains("all lights are off"));
}

TEST_CASE("a light alone that reaches no point is named") {
  Measurement measurement = measured({0, 0}, {0, 0});
  measurement[0].lights.resize(1);
  std::vector<MixedLight> lights(1);
  lights[0].name = "lamp";
  lights[0].power = 1;
  CHECK_THAT(doubts_of(measurement, lights).back(), Contains("light 'lamp' reaches no point"));
}

TEST_CASE("a sky that reaches nothing is told once, its ground never") {
  const auto told = [](const std::vector<std::string>& names, const std::vector<bool>& reaches) {
    std::vector<MixedLight> lights;
    for (const std::string& name : names) lights.emplace_back().name = name;
    for (MixedLight& light : lights) light.power = 1;
    return lights_that_reach_nothing(lights, reaches, "point");
  };
  const auto dark = told({"sun", "sky", "ground"}, {false, false, false});
  REQUIRE(dark.size() == 1);
  CHECK_THAT(dark[0], Contains("no skylight reaches any point") && Contains("no opening"));
  CHECK(told({"sky", "ground"}, {true, false}).empty());
  CHECK(told({"sky_0001", "sky_0002", "ground"}, {false, true, false}).empty());
  CHECK(told({"sky_0001", "sky_0002", "ground"}, {false, false, false}).size() == 1);
  CHECK_THAT(told({"sun", "sky"}, {false, true}).at(0), Contains("another side"));
}

TEST_CASE("points without light are marked, where others have some") {
  Measurement measurement = measured({3, 0}, {2, 0});
  mark_dark_points(measurement);
  CHECK(measurement[0].grid.marks == std::vector<std::string>{"", "no light"});
  Measurement dark = measured({0, 0}, {0, 0});
  mark_dark_points(dark);
  CHECK(dark[0].grid.marks.empty());
}

TEST_CASE("without noise the figures are those of the values, and their errors 0") {
  const Repeats repeats(3, {200, 500, 300, 400});
  const GridStatistics s = statistics_of(repeats, 0, 4);
  CHECK(s.mean.value == 350);
  CHECK(s.minimum.value == 200);
  CHECK(s.maximum.value == 500);
  CHECK(s.uniformity.value == Approx(200.0 / 350));
  CHECK(s.diversity.value == Approx(0.4));
  CHECK(s.minimum_at_most == 200);
  CHECK(s.maximum_at_least == 500);
  for (const Measured& each : {s.mean, s.minimum, s.maximum, s.uniformity, s.diversity}) {
    CHECK(each.standard_error == Approx(0).margin(1e-12));
  }
  const GridStatistics part = statistics_of(repeats, 1, 2);  // only the sensors of the grid count
  CHECK(part.minimum.value == 300);
  CHECK(part.maximum.value == 500);
}

TEST_CASE("the standard error of a sensor is that of the mean of its repeats") {
  const std::vector<Measured> means = means_of(Repeats{{1, 10}, {3, 10}, {5, 10}});
  CHECK(means[0].value == Approx(3));
  CHECK(means[0].standard_error == Approx(2 / std::sqrt(3.0)));
  CHECK(means[1].standard_error == 0);
}

TEST_CASE("a dark grid has no uniformity, and no NaN") {
  const GridStatistics s = statistics_of(Repeats(2, {0, 0}), 0, 2);
  CHECK(s.uniformity.value == 0);
  CHECK(s.diversity.value == 0);
  CHECK(s.uniformity.standard_error == 0);
}

TEST_CASE("standard errors are the spread that repeated measurements have") {
  std::mt19937 random(7);
  double squares_mean = 0, squares_minimum = 0, told_mean = 0, told_minimum = 0;
  constexpr int measurements = 2000;
  for (int i = 0; i < measurements; ++i) {
    const GridStatistics s = statistics_of(noisy(random, 8, 10, 5, 2), 0, 10);
    squares_mean += std::pow(s.mean.value - 122.5, 2);
    squares_minimum += std::pow(s.minimum.value - 100, 2);
    told_mean += std::pow(s.mean.standard_error, 2);
    told_minimum += std::pow(s.minimum.standard_error, 2);
  }
  // Sensors 5 lux apart with a noise of 0.7: the darkest is always the same one. A standard
  // deviation from 2000 samples has an error of 1.6%, that of variances twice as much.
  CHECK(told_mean / squares_mean == Approx(1).epsilon(0.15));
  CHECK(told_minimum / squares_minimum == Approx(1).epsilon(0.15));
}

TEST_CASE("the error of a minimum that noise chooses is that of the sensor it chooses") {
  // 100 sensors all have 100 lux, or the first half has an eighth of the noise.
  const bool alike = GENERATE(true, false);
  const std::size_t repeats = GENERATE(8, 32);
  CAPTURE(alike, repeats);
  constexpr std::size_t sensors = 100;
  constexpr double noise = 5;
  std::mt19937 random(7);
  double spread = 0, mean_minimum = 0, told = 0, of_darkest = 0;
  constexpr int measurements = 2000;
  for (int i = 0; i < measurements; ++i) {
    Repeats values = noisy(random, repeats, sensors, 0, noise);
    const double scale = alike ? 1 : 0.125;
    for (auto& repeat : values) {
      for (std::size_t s = 0; s < sensors / 2; ++s) {
        repeat[s] = static_cast<float>(100 + scale * (static_cast<double>(repeat[s]) - 100));
      }
    }
    const std::vector<Measured> means = means_of(values);
    const auto darkest =
        std::min_element(means.begin(), means.end(),
                         [](const Measured& a, const Measured& b) { return a.value < b.value; });
    const bool quiet = darkest - means.begin() < static_cast<std::ptrdiff_t>(sensors / 2);
    of_darkest += std::pow((quiet ? scale : 1) * noise, 2) / static_cast<double>(repeats);
    const GridStatistics s = statistics_of(values, 0, sensors);
    told += std::pow(s.minimum.standard_error, 2);
    mean_minimum += s.minimum.value;
    spread += std::pow(s.minimum.value, 2);
  }
  mean_minimum /= measurements;
  spread = spread / measurements - mean_minimum * mean_minimum;
  // A variance from 8 values has a deviation of 53%, and the mean of 2000 of them one of 1.2%.
  CHECK(told / of_darkest == Approx(1).epsilon(0.06));
  CHECK(told / measurements > spread);
}

TEST_CASE("the true minimum and maximum lie between what noise pulls down and up") {
  std::mt19937 random(7);
  double low = 0, high = 0, top_low = 0, top_high = 0;
  constexpr int measurements = 500;
  for (int i = 0; i < measurements; ++i) {
    const GridStatistics s = statistics_of(noisy(random, 8, 100, 0, 5), 0, 100);  // all 100 lux
    low += s.minimum.value / measurements;
    high += s.minimum_at_most / measurements;
    top_low += s.maximum_at_least / measurements;
    top_high += s.maximum.value / measurements;
  }
  // The least of 100 normal values is 2.5 deviations low (tables of order statistics).
  CHECK(low == Approx(100 - 2.508 * 5 / std::sqrt(8.0)).epsilon(0.002));
  CHECK(top_high == Approx(100 + 2.508 * 5 / std::sqrt(8.0)).epsilon(0.002));
  // What the left-out repeat says of the chosen sensor is not biased at all here.
  CHECK(high == Approx(100).epsilon(0.002));
  CHECK(top_low == Approx(100).epsilon(0.002));
}

// Repeats of a measurement: each has random numbers of its own, in this run and in all others.

/// One sensor of a furnished room, by few rays.
Readings measured(const Scene& scene, std::uint64_t seed, int repeats) {
  const std::vector<SensorGrid> grids{{"point", {{{1.0, 1.0, 0.75}, {0, 0, 1}}}, {}}};
  MeasuringParameters parameters;
  parameters.by_paths = true;
  parameters.gathering.rays = 64;
  parameters.repeats = repeats;
  parameters.photons.seed = seed;
  return measure_grids(scene, grids, LightMix::of(scene, 683), {}, parameters, Progress::none());
}

TEST_CASE("runs with neighbouring seeds share no repeat") {
  const Scene scene = test::furnished_room();
  std::set<float> values;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Readings readings = measured(scene, seed, 5);
    for (std::size_t repeat = 0; repeat < readings.repeats(); ++repeat) {
      values.insert(readings.total(repeat)[0]);
    }
  }
  CHECK(values.size() == 50);
}

TEST_CASE("readings of neighbouring seeds differ as their standard errors say") {
  const Scene scene = test::furnished_room();
  constexpr int pairs = 200, repeats = 8;
  double squares = 0;
  const auto mean_of = [&](std::uint64_t seed) {
    const Readings readings = measured(scene, seed, repeats);
    std::vector<std::vector<float>> values;
    for (std::size_t repeat = 0; repeat < repeats; ++repeat)
      values.push_back(readings.total(repeat));
    return means_of(values)[0];
  };
  for (std::uint64_t pair = 0; pair < pairs; ++pair) {
    const Measured a = mean_of(2 * pair), b = mean_of(2 * pair + 1);
    squares += std::pow(a.value - b.value, 2) /
               (std::pow(a.standard_error, 2) + std::pow(b.standard_error, 2)) / pairs;
  }
  // The square of a Student t of 14 degrees of freedom has the mean 14 / 12, and the mean of 200 a
  // deviation of 0.13. Pairs that share seven of eight repeats would have an eighth of it.
  CHECK(squares == Approx(14.0 / 12).margin(5 * 0.13));
}

// What standards require, and whether a measurement has it.

GridValues grid(GridRole role, const std::vector<float>& lux, float noise = 0) {
  GridValues values;
  values.grid.name = "plane";
  values.grid.role = role;
  values.grid.sensors.resize(lux.size());
  std::vector<std::vector<float>> repeats(2, lux);
  for (float& value : repeats[0]) value += noise;
  for (float& value : repeats[1]) value -= noise;
  values.lights.push_back({"", means_of(repeats), statistics_of(repeats, 0, lux.size())});
  return values;
}

TEST_CASE("a desk needs 500 lux with a uniformity of 0.60 by EN 12464-1") {
  const Requirement desk = parse_requirement("office-desk");
  CHECK(desk.reference == "EN 12464-1:2021, table 34, required values");
  const auto good = judge(grid(GridRole::task, {400, 600, 700}), desk);
  REQUIRE(good.size() == 2);
  CHECK(good[0].figure == "Em");
  CHECK(good[0].required == 500);
  CHECK(good[0].met());
  CHECK(good[1].measured.value == Approx(400 / (1700.0 / 3)));
  CHECK(good[1].met());
  const auto dark = judge(grid(GridRole::task, {200, 300, 700}), desk);
  CHECK_FALSE(dark[0].met());
  CHECK_FALSE(dark[1].met());
  CHECK_THAT(judgement_text(dark[0]), Contains("NOT MET") && Contains("500"));
}

TEST_CASE("walls, ceilings, cylinders and surroundings have requirements of their own") {
  const Requirement desk = parse_requirement("office-desk");
  const std::vector<float> even{200, 200};
  CHECK(judge(grid(GridRole::wall, even), desk)[0].required == 150);
  CHECK(judge(grid(GridRole::wall, even), desk)[1].required == 0.10);
  CHECK(judge(grid(GridRole::ceiling, even), desk)[0].required == 100);
  CHECK(judge(grid(GridRole::cylindrical, even), desk)[0].required == 150);
  CHECK(judge(grid(GridRole::surroundings, even), desk)[0].required == 300);
  CHECK(judge(grid(GridRole::surroundings, even), desk)[1].required == 0.40);
  CHECK(judge(grid(GridRole::background, even), desk)[0].required == 100);
  CHECK(judge(grid(GridRole::background, even), desk)[1].required == 0.10);
  CHECK(judge(grid(GridRole::other, even), desk).empty());
  CHECK(judge(grid(GridRole::wall, even), parse_requirement("bookshelves")).empty());
  CHECK(mean_of_surroundings(750) == 500);
  CHECK(mean_of_surroundings(300) == 200);
  CHECK(mean_of_surroundings(200) == 150);
  CHECK(mean_of_surroundings(100) == 100);
}

TEST_CASE("each task is judged by its own target, and by the observers to whom it is the nearest") {
  CHECK_THAT(parse_requirement("archive").reference, Contains("not confirmed"));
  Measurement rooms;
  for (const char* target : {"office-desk", "corridor", ""}) {
    rooms.push_back(grid(GridRole::task, {90, 90}));
    rooms.back().grid.target = target;
    const glm::dvec3 middle(10.0 * static_cast<double>(rooms.size()), 0, 0);
    for (Sensor& sensor : rooms.back().grid.sensors) sensor.position = middle;
  }
  const std::vector<RatedObserver> observers{{"a", {9, 1, 0}, {18.5, 0.1}},
                                             {"b", {14, 1, 0}, {19.4, 0.1}},
                                             {"c", {16, 1, 0}, {27.5, 0.1}},
                                             {"d", {29, 1, 0}, {35.0, 0.1}}};
  const auto lines = requirement_lines(judge_targets(rooms, observers));
  REQUIRE(lines.size() == 10);
  CHECK_THAT(lines[0], Contains("target office-desk (EN 12464-1:2021, table 34"));
  CHECK(lines[3] == "  plane, b: UGR 19.4, at most 19: NOT MET");
  CHECK(lines[6] == "  plane: Em 90, at least 100: NOT MET");
  CHECK(lines[8] == "  plane, c: UGR 27.5, at most 28: met");
  CHECK_THAT(requirement_lines(judge_targets(rooms))[3], Contains("see photile glare"));
}

TEST_CASE("a UGR below 10 is stated as data sheets do, and compared by its number") {
  CHECK(glare_text(19.26) == "19.3");
  CHECK(glare_text(10) == "10.0");
  CHECK(glare_text(9.99) == "<10");
  CHECK(glare_text(-7.5) == "<10");
  const auto judged = [](double limit, double rating) {
    return judgement_text({"desk 2", "UGR", limit, {rating, 0.1}, true});
  };
  CHECK(judged(19, -7.5) == "desk 2: UGR <10, at most 19: met");
  CHECK(judged(8, 9) == "desk 2: UGR 9, at most 8: NOT MET");  // a limit of one's own
}

TEST_CASE("within two standard errors of the limit a judgement is doubtful") {
  const Requirement own = parse_requirement("Em=500");
  CHECK(judge(grid(GridRole::task, {505, 505}, 10), own)[0].doubtful());
  CHECK_FALSE(judge(grid(GridRole::task, {540, 540}, 10), own)[0].doubtful());
  CHECK_THAT(judgement_text(judge(grid(GridRole::task, {505, 505}, 10), own)[0]),
             Contains("met, within two standard errors"));
}

TEST_CASE("an escape route needs a lux at each point, and no point of 40 times as much") {
  const Requirement route = parse_requirement("escape-route");
  CHECK(route.is_direct);
  const auto dim = judge(grid(GridRole::task, {0.9f, 30}), route);
  REQUIRE(dim.size() == 2);
  CHECK_THAT(judgement_text(dim[0]), Contains("Emin 0.9, at least 1: NOT MET"));
  CHECK_THAT(judgement_text(dim[1]), Contains("Ud 0.030, at least 0.025: met"));
  CHECK_FALSE(judge(grid(GridRole::task, {1, 41}), route)[1].met());
}

TEST_CASE("requirements of one's own are values by name") {
  const Requirement own =
      parse_requirement("Em=320,Uo=0.5,Emin=100,Ud=0.2,UGR=22,Ez=75,Ewall=60,Eceiling=40,Ra=90");
  CHECK(std::vector{own.mean, own.uniformity, own.least, own.diversity, own.glare, own.cylindrical,
                    own.wall, own.ceiling,
                    own.rendering} == std::vector<double>{320, 0.5, 100, 0.2, 22, 75, 60, 40, 90});
}

TEST_CASE("each known row is of a table, within the ranges of the standard, and has its own name") {
  for (const Requirement& row : known_requirements()) {
    CAPTURE(row.name);
    CHECK(parse_requirement(row.name).what == row.what);
    if (row.is_direct) continue;
    CHECK_THAT(row.reference, Catch::StartsWith("EN 12464-1:2021, table "));
    CHECK((row.mean >= 75 && row.mean <= 1500));
    CHECK((row.uniformity >= 0.4 && row.uniformity <= 0.7));
    CHECK((row.glare == 0 || (row.glare >= 16 && row.glare <= 28)));
    CHECK((row.rendering >= 40 && row.rendering <= 90));
    CHECK(row.cylindrical >= row.wall);
    CHECK((row.wall == 0 || row.wall >= row.ceiling));
  }
}

}  // namespace
}  // namespace photile::test
