// Where the sun stands, against an observatory's example and what geometry says.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "photile/errors.hpp"
#include "weather/perez_sky.hpp"

namespace photile::test {

using namespace photile::daylight;

namespace {

constexpr double per_radian = 180 / std::numbers::pi;

/// The highest that the sun stands on a day, and where, in degrees.
weather::SunPosition highest(const Site& site, int month, int day) {
  weather::SunPosition best;
  for (int minute = 0; minute < 24 * 60; ++minute) {
    const weather::SunPosition at = weather::sun_position(site, {2026, month, day, minute / 60.0});
    if (minute == 0 || at.elevation > best.elevation) best = at;
  }
  return {best.azimuth * per_radian, best.elevation * per_radian};
}

}  // namespace

TEST_CASE("the sun stands where the example of NREL's solar position algorithm has it") {
  // Reda and Andreas 2004: zenith 50.11162 with refraction (0.014 degrees), azimuth 194.34024.
  const weather::SunPosition sun = weather::sun_position(
      {39.742476, -105.1786, -7}, {2003, 10, 17, 12 + 30 / 60.0 + 30 / 3600.0});
  CHECK(sun.elevation * per_radian == Approx(90 - 50.11162 - 0.014).margin(0.02));
  CHECK(sun.azimuth * per_radian == Approx(194.34024).margin(0.02));
}

TEST_CASE("at noon of a solstice the sun is 23.44 degrees from where it is at an equinox") {
  for (const double latitude : {60.0, 35.0}) {
    const Site site{latitude, 0, 0};
    CHECK(highest(site, 6, 21).elevation == Approx(90 - latitude + 23.44).margin(0.02));
    CHECK(highest(site, 12, 21).elevation == Approx(90 - latitude - 23.44).margin(0.02));
    CHECK(highest(site, 6, 21).azimuth == Approx(180).margin(0.6));
  }
  // South of the tropic it culminates in the north.
  const double north = highest({-50, 0, 0}, 12, 21).azimuth;
  CHECK(std::min(north, 360 - north) < 0.6);
}

TEST_CASE("fifteen degrees to the west the same sun stands an hour later") {
  const weather::SunPosition here = weather::sun_position({50, 0, 0}, {2026, 4, 3, 9.0});
  const weather::SunPosition there = weather::sun_position({50, -15, 0}, {2026, 4, 3, 10.0});
  const weather::SunPosition by_zone = weather::sun_position({50, -15, -1}, {2026, 4, 3, 9.0});
  CHECK(there.elevation == Approx(here.elevation).margin(5e-4));
  CHECK(there.azimuth == Approx(here.azimuth).margin(5e-4));
  CHECK(by_zone.elevation == Approx(there.elevation).margin(1e-9));
}

TEST_CASE("in the morning the sun is in the east") {
  const weather::SunPosition sun = weather::sun_position({52.5, 13.4, 1}, {2026, 3, 20, 7.0});
  CHECK(sun.azimuth * per_radian == Approx(97).margin(4));
}

TEST_CASE("days count from the first of January") {
  CHECK(weather::day_of_year({2026, 1, 1}) == 1);
  CHECK(weather::day_of_year({2026, 3, 1}) == 60);
  CHECK(weather::day_of_year({2024, 12, 31}) == 366);
}

TEST_CASE("sites and times are read, others refused") {
  const Site site = Site::parse("52.5,13.4,1");
  CHECK(site.latitude_degrees == 52.5);
  CHECK(site.longitude_degrees == 13.4);
  CHECK(site.time_zone == 1);
  const LocalTime time = LocalTime::parse("2026-06-21T14:30");
  CHECK(time.month == 6);
  CHECK(time.day == 21);
  CHECK(time.hour == 14.5);
  for (const char* text : {"", "1,2", "91,0,0", "0,181,0", "0,0,15", "a,b,c", "1,2,3,4"})
    CHECK_THROWS_AS(Site::parse(text), UsageError);
  for (const char* text :
       {"", "2026-06-21", "2026-02-29T12:00", "2026-06-21T24:00", "2026-06-21T12:60",
        "2026-6-21T12:00", "2026-06-21 12:00", "2026-13-01T12:00", "2026-06-21T-1:00"})
    CHECK_THROWS_AS(LocalTime::parse(text), UsageError);
}

}  // namespace photile::test
