#include "daylight/annual_daylight.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

constexpr int any_common_year = 2026;  ///< weather files join years

/// Adds the luminances with the sun spread over its patches.
template <class Number>
void add_sun(const SkyHour& hour, const std::vector<weather::SkyPatch>& patches,
             Number* luminance) {
  for (const auto& [patch, share] : hour.sun_fractions) {
    luminance[patch] += static_cast<Number>(share * hour.sun_lux / patches[patch].solid_angle());
  }
}

// The product of two matrices in blocks that fit the caches.
constexpr std::size_t hours_at_once = 64, patches_at_once = 128, hours_in_registers = 16;

/// lux[sensor][hour] += sum over patches of row[sensor][patch] x luminance[patch][hour].
///   luminance   by patch, then the block's hours
///   lux         by sensor, `stride` apart
void add_product(const float* rows, std::size_t sensors, std::size_t patches,
                 const float* luminance, std::size_t stride, float* lux) {
  for (std::size_t first = 0; first < patches; first += patches_at_once) {
    const std::size_t last = std::min(patches, first + patches_at_once);
    for (std::size_t sensor = 0; sensor < sensors; ++sensor) {
      const float* const row = rows + sensor * patches;
      for (std::size_t h = 0; h < hours_at_once; h += hours_in_registers) {
        std::array<float, hours_in_registers> sum{};
        for (std::size_t patch = first; patch < last; ++patch) {
          const float weight = row[patch];
          const float* const from = luminance + patch * hours_at_once + h;
          for (std::size_t i = 0; i < hours_in_registers; ++i) sum[i] += weight * from[i];
        }
        for (std::size_t i = 0; i < hours_in_registers; ++i) lux[sensor * stride + h + i] += sum[i];
      }
    }
  }
}

/// Patches that give any sensor light.
std::vector<std::size_t> patches_that_count(const DaylightMatrix& matrix) {
  std::vector<bool> counts(matrix.patches, false);
  for (std::size_t i = 0; i < matrix.from_sky.size(); ++i) {
    if (matrix.from_sky[i] != 0.0f) counts[i % matrix.patches] = true;
  }
  std::vector<std::size_t> found;
  for (std::size_t patch = 0; patch < counts.size(); ++patch) {
    if (counts[patch]) found.push_back(patch);
  }
  return found;
}

}  // namespace

std::vector<SkyHour> sky_hours(const weather::WeatherYear& weather,
                               const std::vector<weather::SkyPatch>& patches, double ground) {
  const weather::SkyInPatches in_patches(patches);
  std::vector<SkyHour> hours(weather.hours.size());
  tbb::parallel_for(std::size_t{0}, hours.size(), [&](std::size_t i) {
    const weather::WeatherHour& from = weather.hours[i];
    SkyHour& hour = hours[i];
    hour.month = from.month;
    hour.day = from.day;
    hour.hour = from.hour;
    hour.weekday = (weather.first_weekday + static_cast<int>(i / 24)) % 7;
    // On the 29th of February the sun is nearly that of the 28th.
    const bool leap_day = from.month == 2 && from.day == 29;
    const LocalTime time{any_common_year, from.month, leap_day ? 28 : from.day, from.hour};
    hour.sun = weather::sun_position(weather.site, time);
    const weather::SkyIrradiance& irradiance = from.irradiance;
    if (irradiance.direct_normal + irradiance.diffuse_horizontal <= 1e-4) return;
    const weather::PerezSky sky(hour.sun.elevation, irradiance, weather::day_of_year(time));
    hour.diffuse_lux = sky.diffuse_illuminance();
    hour.luminance = in_patches.luminances(sky, hour.sun);
    double on_ground = sky.diffuse_illuminance();
    if (hour.sun.elevation > 0 && sky.direct_illuminance() > 0) {
      hour.sun_lux = sky.direct_illuminance();
      hour.sun_fractions = in_patches.sun(hour.sun);
      on_ground += hour.sun_lux * std::sin(hour.sun.elevation);
    }
    hour.luminance.push_back(static_cast<float>(ground * on_ground / glm::pi<double>()));
  });
  return hours;
}

std::vector<double> mean_luminances(const std::vector<SkyHour>& hours,
                                    const std::vector<weather::SkyPatch>& patches) {
  std::vector<double> mean(patches.size() + 1, 0.0);
  for (const SkyHour& hour : hours) {
    if (hour.luminance.empty()) continue;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += double{hour.luminance[i]};
    add_sun(hour, patches, mean.data());
  }
  for (double& luminance : mean) luminance /= static_cast<double>(hours.size());
  return mean;
}

std::vector<float> sun_profile(const DirectLight& straight, const std::vector<SkyHour>& hours,
                               double north, double maintenance) {
  std::vector<float> lux(straight.sensors() * hours.size(), 0.0f);
  tbb::parallel_for(std::size_t{0}, hours.size(), [&](std::size_t h) {
    if (!(hours[h].sun_lux > 0)) return;
    const trace::FlushDenormals flush_denormals;
    const glm::dvec3 to_sun =
        weather::direction_of(hours[h].sun.azimuth + north, hours[h].sun.elevation);
    for (std::size_t sensor = 0; sensor < straight.sensors(); ++sensor) {
      lux[sensor * hours.size() + h] =
          static_cast<float>(maintenance * hours[h].sun_lux * straight.from(to_sun, sensor));
    }
  });
  return lux;
}

std::vector<float> annual_profile(const DaylightMatrix& matrix, const std::vector<SkyHour>& hours,
                                  const std::vector<weather::SkyPatch>& patches,
                                  const std::vector<float>& sun) {
  const std::vector<std::size_t> counting = patches_that_count(matrix);
  std::vector<float> rows(matrix.sensors * counting.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = matrix.from_sky[i / counting.size() * matrix.patches + counting[i % counting.size()]];
  }
  std::vector<std::size_t> lit;
  for (std::size_t h = 0; h < hours.size(); ++h) {
    if (!hours[h].luminance.empty()) lit.push_back(h);
  }
  std::vector<float> lux(matrix.sensors * hours.size(), 0.0f);
  const std::size_t blocks = (lit.size() + hours_at_once - 1) / hours_at_once;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const trace::FlushDenormals flush_denormals;
    const std::size_t first = block * hours_at_once;
    const std::size_t count = std::min(hours_at_once, lit.size() - first);
    std::vector<float> luminance(counting.size() * hours_at_once, 0.0f);
    std::vector<float> found(matrix.sensors * hours_at_once, 0.0f), mixed;
    for (std::size_t i = 0; i < count; ++i) {
      const SkyHour& hour = hours[lit[first + i]];
      mixed = hour.luminance;
      if (sun.empty()) add_sun(hour, patches, mixed.data());
      for (std::size_t patch = 0; patch < counting.size(); ++patch)
        luminance[patch * hours_at_once + i] = mixed[counting[patch]];
    }
    add_product(rows.data(), matrix.sensors, counting.size(), luminance.data(), hours_at_once,
                found.data());
    for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
      for (std::size_t i = 0; i < count; ++i) {
        const SkyHour& hour = hours[lit[first + i]];
        const std::size_t at = sensor * hours.size() + lit[first + i];
        double all = double{found[sensor * hours_at_once + i]};
        if (!sun.empty()) {
          for (const auto& [patch, share] : hour.sun_fractions) {
            const std::size_t of_patch = sensor * matrix.patches + patch;
            all += share * hour.sun_lux / patches[patch].solid_angle() *
                   double{matrix.from_sky[of_patch] - matrix.straight[of_patch]};
          }
          all += double{sun[at]};
        }
        lux[at] = static_cast<float>(std::max(0.0, all));
      }
    }
  });
  return lux;
}

}  // namespace photile::daylight
