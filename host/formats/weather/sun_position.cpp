#include "weather/sun_position.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace photile::weather {
namespace {

using std::numbers::pi;
constexpr double radians = pi / 180;

std::chrono::sys_days date_of(const LocalTime& time) {
  using namespace std::chrono;
  return year(time.year) / month(static_cast<unsigned>(time.month)) /
         day(static_cast<unsigned>(time.day));
}

}  // namespace

SunPosition sun_position(const Site& site, const LocalTime& time) {
  using namespace std::chrono;
  // Days since the noon of the first of January 2000 in Greenwich.
  const sys_days epoch = year(2000) / 1 / 1;
  const double days = static_cast<double>((date_of(time) - epoch).count()) - 0.5 +
                      (time.hour - site.time_zone) / 24;
  const double mean_longitude = (280.460 + 0.9856474 * days) * radians;
  const double anomaly = (357.528 + 0.9856003 * days) * radians;
  const double longitude =
      mean_longitude + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * radians;
  const double obliquity = (23.439 - 4e-7 * days) * radians;
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal_hours = 18.697374558 + 24.06570982441908 * days;
  const double hour_angle =
      (15 * sidereal_hours + site.longitude_degrees) * radians - right_ascension;
  const double latitude = site.latitude_degrees * radians;
  const double sine = std::sin(declination) * std::sin(latitude) +
                      std::cos(declination) * std::cos(latitude) * std::cos(hour_angle);
  const double azimuth =
      std::atan2(-std::cos(declination) * std::sin(hour_angle),
                 std::sin(declination) * std::cos(latitude) -
                     std::cos(declination) * std::sin(latitude) * std::cos(hour_angle));
  return {azimuth < 0 ? azimuth + 2 * pi : azimuth, std::asin(std::clamp(sine, -1.0, 1.0))};
}

int day_of_year(const LocalTime& time) {
  using namespace std::chrono;
  return static_cast<int>((date_of(time) - sys_days(year(time.year) / 1 / 1)).count()) + 1;
}

}  // namespace photile::weather
