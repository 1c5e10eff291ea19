// Figures of a year, and what people do to it.
#include "daylight/daylight_metrics.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include "daylight/sky_states.hpp"
#include "photile/errors.hpp"
#include "room_with_window.hpp"
#include "temporary_folder.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using Room = RoomWithWindow;
using namespace daylight;
using std::numbers::pi;

// Figures of a year against years made by hand.

/// A year of 365 equal days; diffuse light from 6 to 18, brighter every hour.
std::vector<SkyHour> equal_days() {
  std::vector<SkyHour> hours;
  for (int day = 0; day < 365; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      SkyHour entry;
      entry.hour = hour + 0.5;
      entry.diffuse_lux = hour >= 6 && hour < 18 ? 1000.0 + hour : 0.0;
      hours.push_back(entry);
    }
  }
  return hours;
}

/// A year of the same lux every day, by hour.
std::vector<float> daily(const std::function<float(int hour)>& lux) {
  std::vector<float> year;
  for (int i = 0; i < 8760; ++i) year.push_back(lux(i % 24));
  return year;
}

TEST_CASE("3,650 hours are those from 8 to 18, and 4,380 those of daylight") {
  const auto hours = equal_days();
  const auto occupied = occupied_hours(hours, {});
  CHECK(std::count(occupied.begin(), occupied.end(), true) == 3650);
  const auto daylight = daylight_hours(hours);
  CHECK(std::count(daylight.begin(), daylight.end(), true) == 4380);
  CHECK(daylight[6]);
  CHECK(!daylight[5]);
  CHECK(!daylight[18]);
  CHECK(median_outdoors(hours) == 1012);  // six of the twelve hours have as much
}

TEST_CASE("autonomy, useful daylight, sun and median of a point are counted by the hour") {
  const auto hours = equal_days();
  const auto occupied = occupied_hours(hours, {}), daylight = daylight_hours(hours);
  // 8 to 18: 50, 150, 250, 300, 350, 450, 3000, 4000, 5000, 50
  const float by_hour[]{50, 150, 250, 300, 350, 450, 3000, 4000, 5000, 50};
  const auto lux = daily([&](int h) { return h >= 8 && h < 18 ? by_hour[h - 8] : 0.0f; });
  // Above 1,000 lux once a day, and once 1,000 alone.
  const auto sun = daily([&](int h) { return h == 12 ? 1001.0f : h == 13 ? 1000.0f : 0.0f; });
  const PointDaylight point = point_daylight(lux, sun, occupied, daylight, 300);
  CHECK(point.autonomy == Approx(0.6));
  CHECK(point.continuous_autonomy == Approx(0.6 + (50 + 150 + 250 + 50) / 300.0 / 10));
  CHECK(point.useful[0] == Approx(0.2));
  CHECK(point.useful[1] == Approx(0.2));
  CHECK(point.useful[2] == Approx(0.3));
  CHECK(point.useful[3] == Approx(0.3));
  CHECK(point.sun_hours == 365);
  CHECK(point.mean_lux == Approx(13600 / 24.0));
  // Six of the twelve hours from 6 on have 300 lux or more.
  CHECK(point.median_lux == 300);
}

TEST_CASE("a room has autonomy where its points have it in half of the hours") {
  std::vector<PointDaylight> points(10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].autonomy = i < 6 ? 0.5 : 0.49;
    points[i].sun_hours = i < 2 ? 251 : 250;
    points[i].median_lux = i == 9 ? 90 : 100 + 100.0 * static_cast<double>(i);
  }
  const RoomDaylight room = room_daylight(points);
  CHECK(room.spatial_autonomy == Approx(0.6));
  CHECK(room.sunlight_exposure == Approx(0.2));
  // Medians 900, 800, ... 100, 90: half reach 500; 95% of ten points is all of them.
  CHECK(room.target_lux == 500);
  CHECK(room.minimum_target_lux == 90);
  CHECK(room.level == "none");
}

TEST_CASE("levels of EN 17037 ask both targets") {
  const auto level = [](double target, double minimum) {
    std::vector<PointDaylight> points(20);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].median_lux = i < 10 ? target : minimum;
    return room_daylight(points).level;
  };
  CHECK(level(299, 299) == "none");
  CHECK(level(300, 100) == "minimum");
  CHECK(level(800, 100) == "minimum");
  CHECK(level(500, 300) == "medium");
  CHECK(level(749, 600) == "medium");
  CHECK(level(750, 500) == "high");
}

TEST_CASE("lamps burn what daylight lacks") {
  const auto hours = equal_days();
  const auto occupied = occupied_hours(hours, {});
  // 5 h with enough, 4 h with half of it, 1 h dark, of 500 lux; the lamps reach 400.
  std::vector<double> mean;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const int h = static_cast<int>(i % 24);
    mean.push_back(h < 13 ? 600 : h < 17 ? 250 : 0);
  }
  const std::vector<double> lux{100, 300}, watts{20, 60};
  const auto energy = lamp_energy(mean, occupied, {"a", "b"}, lux, watts, 500);
  REQUIRE(energy.size() == 2);
  const double full_hours = 365 * (4 * 250.0 / 400 + 1);
  CHECK(energy[0].kilowatt_hours == Approx(20 * full_hours / 1000));
  CHECK(energy[1].kilowatt_hours == Approx(60 * full_hours / 1000));
  CHECK(energy[1].undimmed == Approx(60 * 3650 / 1000.0));
}

// Hours in which rooms are used.

/// A year that begins on a Sunday.
std::vector<SkyHour> year() {
  std::vector<SkyHour> hours(8760);
  for (std::size_t i = 0; i < hours.size(); ++i) {
    hours[i].hour = static_cast<double>(i % 24) + 0.5;
    hours[i].weekday = static_cast<int>((6 + i / 24) % 7);
  }
  return hours;
}

std::ptrdiff_t count(const Occupancy& occupancy) {
  const auto occupied = occupied_hours(year(), occupancy);
  return std::count(occupied.begin(), occupied.end(), true);
}

TEST_CASE("working days are counted by the calendar of the weather") {
  Occupancy occupancy;
  CHECK(count(occupancy) == 3650);
  occupancy.set_hours("9-17");
  occupancy.set_days("mon-fri");
  CHECK(count(occupancy) == 8 * (365 - 53 - 52));  // 53 Sundays
  occupancy.set_days("Sun");
  CHECK(count(occupancy) == 8 * 53);
  occupancy.set_days("sat-mon,wed");
  CHECK(count(occupancy) == 8 * (53 + 3 * 52));
}

TEST_CASE("a schedule has a value for each hour") {
  const TemporaryFolder folder;
  std::string text = "hour,occupancy\n";
  for (int i = 0; i < 8760; ++i) text += i % 24 == 10 ? "x,0.5\n" : "x,0\n";
  Occupancy occupancy;
  occupancy.schedule = folder.path / "a.csv";
  std::ofstream(occupancy.schedule) << text;
  CHECK(count(occupancy) == 365);
}

// Blinds: panes that let less through, and hours in which they close, by hand.

Material pane(const std::string& name) {
  Material material;
  material.name = name;
  material.interaction = Interaction::glass;
  material.thin = true;
  material.index_of_refraction = 1.5f;
  return material;
}

TEST_CASE("a window group closes where more than 2% of the points have sun of 1,000 lux") {
  // 100 points, 4 hours: no sun, sun on 2 points, on 3 points, on 3 points through closed blinds.
  constexpr std::size_t sensors = 100, hours = 4;
  std::vector<std::vector<float>> sun(2, std::vector<float>(sensors * hours, 0.0f));
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    if (sensor < 2) sun[0][sensor * hours + 1] = 50'000;
    sun[0][sensor * hours + 2] = 1'000;
    sun[0][sensor * hours + 3] = sun[1][sensor * hours + 3] = 20'000;
  }
  const std::vector<int> closed{0, 1};
  CHECK(blind_schedule(sun, closed, sensors, hours) == std::vector<std::size_t>{0, 0, 1, 1});
}

TEST_CASE("of several groups as few close as keep the sun out") {
  // Hours with sun through neither, the first, the second and both of two groups.
  std::vector<std::vector<float>> sun{
      {0, 2000, 2000, 2000}, {0, 0, 2000, 2000}, {0, 2000, 0, 2000}, {0, 0, 0, 0}};
  const std::vector<int> closed{0, 1, 1, 2};
  CHECK(blind_schedule(sun, closed, 1, 4) == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("a mean without each of its parts has the standard error of the mean") {
  const std::vector<double> values{3, 5, 4, 8};  // standard deviation sqrt(14 / 3)
  const std::vector<double> without{17.0 / 3, 15.0 / 3, 16.0 / 3, 12.0 / 3};
  CHECK(jackknife_error(5, without, std::vector<double>(4, 0.25)) ==
        Approx(std::sqrt(14.0 / 3 / 4)));
  // Two parts, of which one counts thrice: 3 (a - b)^2 / 16 by the formula for parts of any size.
  CHECK(jackknife_error(4.5, std::vector<double>{6, 4}, std::vector<double>{0.75, 0.25}) ==
        Approx(std::sqrt(3 * 4.0 / 16)));
  CHECK(jackknife_error(5, std::vector<double>{5}, std::vector<double>{1}) == 0);
}

TEST_CASE("stated errors of DA and sDA are the scatter of years") {
  // DA of the points lies around a half; the light of a round is off by what it has in common, and
  // by each point's own.
  constexpr std::size_t count = 60, parts = 8, years = 400;
  const double common = GENERATE(0.0, 0.03);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> found[2], stated[2]{{0}, {0}};
  for (std::size_t year = 0; year < years; ++year) {
    std::vector<PointDaylight> points(count);
    std::vector<std::vector<PointDaylight>> without(parts, points);
    for (std::size_t part = 0; part < parts; ++part) {
      const double shared = common * normal(random);
      for (std::size_t i = 0; i < count; ++i) {
        const double here = 0.35 + 0.005 * static_cast<double>(i) + shared + 0.03 * normal(random);
        points[i].autonomy += here / parts;
        for (std::size_t other = 0; other < parts; ++other) {
          if (other != part) without[other][i].autonomy += here / (parts - 1);
        }
      }
    }
    const auto errors = daylight_errors(points, without, std::vector<double>(parts, 1.0 / parts));
    const RoomDaylight room = room_daylight(points);
    found[0].push_back(room.autonomy);
    found[1].push_back(room.spatial_autonomy);
    stated[0][0] += errors.autonomy * errors.autonomy / years;
    stated[1][0] += errors.spatial_autonomy * errors.spatial_autonomy / years;
  }
  for (int figure = 0; figure < 2; ++figure) {
    double mean = 0, variance = 0;
    for (const double value : found[figure]) mean += value / years;
    for (const double value : found[figure])
      variance += (value - mean) * (value - mean) / (years - 1);
    CAPTURE(figure, common);
    CHECK(std::sqrt(stated[figure][0] / variance) == Approx(1).epsilon(0.15));
  }
}

TEST_CASE("rounds of a sky are their mean, with and without a part, and none is another again") {
  Scene scene = Room::builder(diffuse(0.5f)).build();
  scene.portals = {Room::window()};
  Year year{{}, weather::sky_patches(145), {{{1.8, 0.8, 3.0}, {0, 1, 0}}}, true, {}};
  year.parameters.measuring.gathering.rays = 16;
  year.parameters.measuring.repeats = 2;
  year.parameters.mean_luminance.assign(146, 1.0);
  SkyRounds rounds;
  std::vector<double> each;
  const auto all = [](const std::vector<SkyState>& states) {
    const DaylightMatrix& matrix = states.front().matrix;
    return std::accumulate(matrix.from_sky.begin(), matrix.from_sky.end(), 0.0);
  };
  for (std::size_t i = 0; i <= SkyRounds::most_parts; ++i) {
    auto round = sky_states(rounds.year_of_next(year), scene, {}, Progress::none());
    each.push_back(all(round));
    rounds.add(std::move(round));
  }
  std::vector<double> sorted = each;
  std::sort(sorted.begin(), sorted.end());
  CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
  const double sum = std::accumulate(each.begin(), each.end(), 0.0);
  CHECK(all(rounds.mean()) == Approx(sum / 9));
  CHECK(rounds.part_fractions().front() == Approx(2.0 / 9));
  CHECK(all(rounds.mean(0)) == Approx((sum - each.front() - each.back()) / 7));
}

TEST_CASE("a closed pane lets through what is asked for") {
  SceneBuilder builder = Room::builder(diffuse(0.0f));
  const auto glass = builder.add(pane("glazing"));
  builder.quad({Room::left, Room::sill, 0}, {Room::right, Room::sill, 0},
               {Room::right, Room::head, 0}, {Room::left, Room::head, 0}, glass);
  Scene scene = builder.build();
  scene.portals = {Room::window()};
  Year year{{}, weather::sky_patches(145), {{{1.8, 1.4, 3.0}, {0, 0, -1}}}, false, {}};
  year.parameters.measuring.gathering.rays = 256;
  year.parameters.measuring.repeats = 4;
  year.parameters.mean_luminance.assign(146, 1.0);
  const std::vector<BlindGroup> groups{BlindGroup::parse("glaz*=0.05")};
  const auto states = sky_states(year, scene, groups, Progress::none());
  REQUIRE(states.size() == 2);
  CHECK(states[0].name == "open");
  CHECK(states[1].name == "closed");
  const double bare =
      pi * validation::rectangle_factor(year.sensors[0].position, year.sensors[0].normal,
                                        {Room::left, Room::sill, 0}, {1.2, 0, 0}, {0, 1, 0});
  const auto all = [&](const SkyState& state) {
    double sum = 0;
    for (std::size_t patch = 0; patch < state.matrix.patches; ++patch)
      sum += state.matrix.coefficient(0, patch);
    return sum;
  };
  // Both faces of glass of index 1.5 together reflect 7.7% of light at normal incidence.
  CHECK(all(states[0]) == Approx(bare * 0.923).epsilon(0.02));
  CHECK(all(states[1]) == Approx(bare * 0.05).epsilon(0.02));
}

TEST_CASE("blinds close panes that are partly there, as IFC has them") {
  SceneBuilder builder = Room::builder(diffuse(0.0f));
  Material ifc = diffuse({0.0f, 0.5f, 0.75f});
  ifc.name = "glazing";
  ifc.opacity = 0.1f;
  builder.add(ifc);
  const Scene scene = builder.build();
  const std::vector<BlindGroup> groups{BlindGroup::parse("glazing=0.05")};
  CHECK(double{materials_with(scene, groups, 0).back().opacity} == Approx(0.1));
  CHECK(double{materials_with(scene, groups, 1).back().opacity} == Approx(0.95));
}

}  // namespace
}  // namespace photile::test
