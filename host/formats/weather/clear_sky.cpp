#include "weather/clear_sky.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace photile::weather {
namespace {

struct Month {
  double day;         ///< of the year: the 21st
  double irradiance;  ///< A, W/m2
  double extinction;  ///< B
  double diffuse;     ///< C
};

constexpr std::array<Month, 12> monthly{{{21, 1202, 0.141, 0.103},
                                         {52, 1187, 0.142, 0.104},
                                         {80, 1164, 0.149, 0.109},
                                         {111, 1130, 0.164, 0.120},
                                         {141, 1106, 0.177, 0.130},
                                         {172, 1092, 0.185, 0.137},
                                         {202, 1093, 0.186, 0.138},
                                         {233, 1107, 0.182, 0.134},
                                         {264, 1136, 0.165, 0.121},
                                         {294, 1166, 0.152, 0.111},
                                         {325, 1190, 0.144, 0.106},
                                         {355, 1204, 0.141, 0.103}}};
constexpr double days_of_year = 365;

/// Between the two 21sts around a day.
Month month_at(int day) {
  const double today = day < monthly.front().day ? day + days_of_year : day;
  std::size_t last = monthly.size() - 1;
  while (monthly[last].day > today) --last;
  const Month& before = monthly[last];
  const Month& after = monthly[(last + 1) % monthly.size()];
  const double days = std::fmod(after.day - before.day + days_of_year, days_of_year);
  const double share = (today - before.day) / days;
  return {today, std::lerp(before.irradiance, after.irradiance, share),
          std::lerp(before.extinction, after.extinction, share),
          std::lerp(before.diffuse, after.diffuse, share)};
}

}  // namespace

SkyIrradiance clear_sky(double sun_elevation, int day) {
  if (!(sun_elevation > 0)) return {};
  const Month month = month_at(day);
  const double direct = month.irradiance * std::exp(-month.extinction / std::sin(sun_elevation));
  return {direct, month.diffuse * direct};
}

}  // namespace photile::weather
