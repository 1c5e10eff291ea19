#include "daylight/annual_daylight.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "trace/flush_denormals.hpp"

namespace photile::daylight {
namespace {

constexpr int any_common_year = 2026;  ///< weather files join years

/// In lanes, so that it runs as vectors.
float dot(const float* a, const float* b, std::size_t count) {
  constexpr std::size_t lanes = 8;
  std::array<float, lanes> sums{};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  }
  float sum = 0;
  for (; i < count; ++i) sum += a[i] * b[i];
  for (const float lane : sums) sum += lane;
  return sum;
}

/// Luminances with the sun spread over its patches.
std::vector<double> with_sun(const SkyHour& hour, const std::vector<SkyPatch>& patches) {
  std::vector<double> luminance = hour.luminance;
  for (const auto& [patch, share] : hour.sun_shares)
    luminance[patch] += share * hour.sun_lux / patches[patch].solid_angle();
  return luminance;
}

}  // namespace

std::vector<SkyHour> sky_hours(const scene_io::WeatherYear& weather,
                               const std::vector<SkyPatch>& patches, double ground) {
  std::vector<SkyHour> hours(weather.hours.size());
  tbb::parallel_for(std::size_t{0}, hours.size(), [&](std::size_t i) {
    const scene_io::WeatherHour& from = weather.hours[i];
    SkyHour& hour = hours[i];
    hour.month = from.month;
    hour.day = from.day;
    hour.hour = from.hour;
    // The 29th of February has the sun of the 28th, all but.
    const bool leap_day = from.month == 2 && from.day == 29;
    const LocalTime time{any_common_year, from.month, leap_day ? 28 : from.day, from.hour};
    hour.sun = sun_position(weather.site, time);
    const SkyIrradiance& irradiance = from.irradiance;
    if (irradiance.direct_normal + irradiance.diffuse_horizontal <= 1e-4) return;
    const PerezSky sky(hour.sun.elevation, irradiance, day_of_year(time));
    hour.diffuse_lux = sky.diffuse_illuminance();
    hour.luminance = patch_luminances(patches, sky, hour.sun);
    double on_ground = sky.diffuse_illuminance();
    if (hour.sun.elevation > 0 && sky.direct_illuminance() > 0) {
      hour.sun_lux = sky.direct_illuminance();
      hour.sun_shares = sun_patches(patches, hour.sun);
      on_ground += hour.sun_lux * std::sin(hour.sun.elevation);
    }
    hour.luminance.push_back(ground * on_ground / glm::pi<double>());
  });
  return hours;
}

std::vector<double> mean_luminances(const std::vector<SkyHour>& hours,
                                    const std::vector<SkyPatch>& patches) {
  std::vector<double> mean(patches.size() + 1, 0.0);
  for (const SkyHour& hour : hours) {
    if (hour.luminance.empty()) continue;
    const std::vector<double> luminance = with_sun(hour, patches);
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += luminance[i] / static_cast<double>(hours.size());
  }
  return mean;
}

AnnualProfile annual_profile(const DaylightMatrix& matrix, const std::vector<SkyHour>& hours,
                             const std::vector<SkyPatch>& patches, double north, double maintenance,
                             const StraightLight* straight) {
  AnnualProfile profile;
  profile.hours = hours.size();
  profile.all.assign(matrix.sensors * hours.size(), 0.0f);
  if (straight != nullptr) profile.sun = profile.all;
  tbb::parallel_for(std::size_t{0}, hours.size(), [&](std::size_t h) {
    const SkyHour& hour = hours[h];
    if (hour.luminance.empty()) return;
    const trace::FlushDenormals flush_denormals;
    const std::vector<double> mixed =
        straight == nullptr ? with_sun(hour, patches) : hour.luminance;
    const std::vector<float> luminance(mixed.begin(), mixed.end());
    const glm::dvec3 to_sun = direction_of(hour.sun.azimuth + north, hour.sun.elevation);
    for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
      const float* row = matrix.from_sky.data() + sensor * matrix.patches;
      double lux = dot(row, luminance.data(), matrix.patches);
      if (straight != nullptr && hour.sun_lux > 0) {
        for (const auto& [patch, share] : hour.sun_shares) {
          const std::size_t at = sensor * matrix.patches + patch;
          lux += share * hour.sun_lux / patches[patch].solid_angle() *
                 double{matrix.from_sky[at] - matrix.straight[at]};
        }
        const double sun = maintenance * hour.sun_lux * straight->from(to_sun, sensor);
        profile.sun[sensor * hours.size() + h] = static_cast<float>(sun);
        lux += sun;
      }
      profile.all[sensor * hours.size() + h] = static_cast<float>(std::max(0.0, lux));
    }
  });
  return profile;
}

}  // namespace photile::daylight
