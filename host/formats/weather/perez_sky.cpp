#include "weather/perez_sky.hpp"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace photile::weather {

std::string_view compass_point(double degrees) {
  constexpr std::array<std::string_view, 8> points{"north", "northeast", "east", "southeast",
                                                   "south", "southwest", "west", "northwest"};
  const double turns = degrees / 360 - std::floor(degrees / 360);
  return points[static_cast<std::size_t>(std::lround(8 * turns)) % points.size()];
}

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

namespace {

using std::numbers::pi;
constexpr double degree = pi / 180;
constexpr double solar_constant = 1367;  // W/m2
constexpr std::size_t bins = 8;          // of clearness

/// Where the bins of clearness end (1990, table 1).
constexpr std::array<double, bins> bin_ends{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200, 1e9};

/// Coefficients of a to e, four of each (1993, table 1).
constexpr std::array<std::array<double, 20>, bins> shapes{{
    {1.3525, -0.2576, -0.2690, -1.4366, -0.7670, 0.0007, 1.2734, -0.1233, 2.8000,  0.6004,
     1.2375, 1.0000,  1.8734,  0.6297,  0.9738,  0.2809, 0.0356, -0.1246, -0.5718, 0.9938},
    {-1.2219, -0.7730, 1.4148,  1.1016,  -0.2054, 0.0367, -3.9128, 0.9156, 6.9750,  0.1774,
     6.4477,  -0.1239, -1.5798, -0.5081, -1.7812, 0.1080, 0.2624,  0.0672, -0.2190, -0.4285},
    {-1.1000,  -0.2515, 0.8952,  0.0156, 0.2782, -0.1812, -4.5000, 1.1766, 24.7219, -13.0812,
     -37.7000, 34.8438, -5.0000, 1.5218, 3.9229, -2.6204, -0.0156, 0.1597, 0.4199,  -0.5562},
    {-0.5484,  -0.6654, -0.2672, 0.7117, 0.7234, -0.6219, -5.6812, 2.6297,  33.3389, -18.3000,
     -62.2500, 52.0781, -3.5000, 0.0016, 1.1477, 0.1062,  0.4659,  -0.3296, -0.0876, -0.0329},
    {-0.6000,  -0.3566, -2.5000, 2.3250,  0.2937, 0.0496, -5.6812, 1.8415, 21.0000, -4.7656,
     -21.5906, 7.2492,  -3.5000, -0.1554, 1.4062, 0.3988, 0.0032,  0.0766, -0.0656, -0.1294},
    {-1.0156, -0.3670, 1.0078,  1.4051,  0.2875,  -0.5328, -3.8500, 3.3750, 14.0000, -0.9999,
     -7.1406, 7.5469,  -3.4000, -0.1078, -1.0750, 1.5702,  -0.0672, 0.4016, 0.3017,  -0.4844},
    {-1.0000, 0.0211,  0.5025,  -0.5119, -0.3000, 0.1922, 0.7023, -1.6317, 19.0000, -5.0000,
     1.2438,  -1.9094, -4.0000, 0.0250,  0.3844,  0.2656, 1.0468, -0.3788, -2.4517, 1.4656},
    {-1.0500,  0.0289,  0.4260,  0.3590, -0.3250, 0.1156, 0.7781, 0.0025,  31.0625, -14.5000,
     -46.1148, 55.3750, -7.2312, 0.4050, 13.3500, 0.6234, 1.5000, -0.6426, 1.8564,  0.5636},
}};

/// Luminous efficacies (1990, table 4), lm/W.
using Efficacy = std::array<double, 4>;
constexpr std::array<Efficacy, bins> diffuse_efficacies{{{97.24, -0.46, 12.00, -8.91},
                                                         {107.22, 1.15, 0.59, -3.95},
                                                         {104.97, 2.96, -5.53, -8.77},
                                                         {102.39, 5.59, -13.95, -13.90},
                                                         {100.71, 5.94, -22.75, -23.74},
                                                         {106.42, 3.83, -36.15, -28.83},
                                                         {141.88, 1.90, -53.24, -14.03},
                                                         {152.23, 0.35, -45.27, -7.98}}};
constexpr std::array<Efficacy, bins> direct_efficacies{{{57.20, -4.55, -2.98, 117.12},
                                                        {98.99, -3.46, -1.21, 12.38},
                                                        {109.83, -4.90, -1.71, -8.81},
                                                        {110.34, -5.84, -1.99, -4.56},
                                                        {106.36, -3.97, -1.75, -6.16},
                                                        {107.19, -1.25, -1.51, -26.73},
                                                        {105.75, 0.77, -1.26, -34.44},
                                                        {101.18, 1.58, -1.10, -8.29}}};

/// The extraterrestrial irradiance over its mean, by the Earth's orbit.
double eccentricity(int day) {
  const double angle = 2 * pi * (day - 1) / 365;
  return 1.00011 + 0.034221 * std::cos(angle) + 0.00128 * std::sin(angle) +
         0.000719 * std::cos(2 * angle) + 0.000077 * std::sin(2 * angle);
}

/// Relative optical air mass (Kasten 1966).
double air_mass(double zenith) {
  return 1 / (std::cos(zenith) + 0.15 * std::pow(93.885 - zenith / degree, -1.253));
}

std::array<double, 5> shape_of(std::size_t bin, double zenith, double clearness,
                               double brightness) {
  if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
  const std::array<double, 20>& x = shapes[bin];
  std::array<double, 5> shape{};
  for (std::size_t i = 0; i < shape.size(); ++i) {
    shape[i] =
        x[4 * i] + x[4 * i + 1] * zenith + brightness * (x[4 * i + 2] + x[4 * i + 3] * zenith);
  }
  if (bin > 0) return shape;
  // Equations 7 and 8.
  shape[2] = std::exp(std::pow(brightness * (x[8] + x[9] * zenith), x[10])) - x[11];
  shape[3] = -std::exp(brightness * (x[12] + x[13] * zenith)) + x[14] + brightness * x[15];
  return shape;
}

}  // namespace

double zenith_of_sun(double sun_elevation) {
  return std::clamp(pi / 2 - sun_elevation, 3 * degree, pi / 2);
}

PerezSky::PerezSky(double sun_elevation, const SkyIrradiance& irradiance, int day) {
  const double zenith = zenith_of_sun(sun_elevation);
  const double cubed = 1.041 * zenith * zenith * zenith;
  const double diffuse = std::max(0.0, irradiance.diffuse_horizontal);
  const double direct = std::max(0.0, irradiance.direct_normal);
  // A sky without diffuse light is as clear as the model goes.
  const double ratio = diffuse > 0 ? (diffuse + direct) / diffuse : (direct > 0 ? 1e9 : 1.0);
  clearness_ = std::clamp((ratio + cubed) / (1 + cubed), 1.0, 11.9);
  brightness_ =
      std::clamp(diffuse * air_mass(zenith) / (solar_constant * eccentricity(day)), 0.01, 0.6);
  std::size_t bin = 0;
  while (clearness_ >= bin_ends[bin]) ++bin;
  const double water = std::exp(0.07 * irradiance.dew_point - 0.075);  // cm
  const Efficacy& of_sky = diffuse_efficacies[bin];
  const Efficacy& of_sun = direct_efficacies[bin];
  diffuse_ = diffuse * (of_sky[0] + of_sky[1] * water + of_sky[2] * std::cos(zenith) +
                        of_sky[3] * std::log(brightness_));
  direct_ =
      direct * std::max(0.0, of_sun[0] + of_sun[1] * water +
                                 of_sun[2] * std::exp(5.73 * zenith - 5) + of_sun[3] * brightness_);
  diffuse_ = std::max(0.0, diffuse_);
  shape_ = shape_of(bin, zenith, clearness_, brightness_);
}

float PerezSky::gradation(float sine) const {
  // gendaylit's least sine: at the horizon itself the law has none.
  return 1 + static_cast<float>(shape_[0]) *
                 std::exp(static_cast<float>(shape_[1]) / std::max(sine, 0.01f));
}

float PerezSky::indicatrix(float cosine) const {
  cosine = std::clamp(cosine, -1.0f, 1.0f);
  return 1 +
         static_cast<float>(shape_[2]) *
             std::exp(static_cast<float>(shape_[3]) * std::acos(cosine)) +
         static_cast<float>(shape_[4]) * cosine * cosine;
}

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
