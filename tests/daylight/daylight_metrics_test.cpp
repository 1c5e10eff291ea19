// Figures of a year against years made by hand.
#include "daylight/daylight_metrics.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

namespace photile::test {

using namespace photile::daylight;

namespace {

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

}  // namespace

TEST_CASE("3,650 hours are those from 8 to 18, and 4,380 those of daylight") {
  const auto hours = equal_days();
  const auto occupied = occupied_hours(hours, {});
  CHECK(std::count(occupied.begin(), occupied.end(), true) == 3650);
  const auto daylight = daylight_hours(hours);
  CHECK(std::count(daylight.begin(), daylight.end(), true) == 4380);
  CHECK(daylight[6]);
  CHECK(!daylight[5]);
  CHECK(!daylight[18]);
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

}  // namespace photile::test
