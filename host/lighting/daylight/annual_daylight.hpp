// Every hour of a year as a mix of the sky's patches and the sun.
#pragma once

#include <cstdint>
#include <vector>

#include "daylight/daylight_matrix.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"

namespace photile::daylight {

/// The representation of the sun.
enum class SunModel : std::uint8_t {
  rays,    ///< its own rays to each sensor, and what it gives by reflection as the nearest patches
  patches  ///< the nearest patches alone, as in Radiance's two-phase method
};

/// The sky of one hour.
struct SkyHour {
  int month = 1, day = 1;
  int weekday = 0;    ///< 0 = Monday
  double hour = 0.5;  ///< the middle, standard time
  weather::SunPosition sun;
  double sun_lux = 0;            ///< facing it; 0 below the horizon
  double diffuse_lux = 0;        ///< horizontal
  std::vector<float> luminance;  ///< cd/m2 of the patches, then of the ground, without the sun
  std::vector<weather::PatchShare> sun_fractions;  ///< empty where there is no sun
};

/// The hours of a weather file. Of hours without light the luminances are empty.
///   ground   reflectance of the ground, which the sky and the sun light
std::vector<SkyHour> sky_hours(const weather::WeatherYear& weather,
                               const std::vector<weather::SkyPatch>& patches, double ground);

/// Mean of the patches' luminances over all hours, the sun spread on the nearest, cd/m2.
std::vector<double> mean_luminances(const std::vector<SkyHour>& hours,
                                    const std::vector<weather::SkyPatch>& patches);

/// Lux straight from the sun, by sensor, then hour.
///   north   radians clockwise from -z
std::vector<float> sun_profile(const DirectLight& straight, const std::vector<SkyHour>& hours,
                               double north, double maintenance);

/// Lux of every hour at every sensor, by sensor, then hour.
///   sun   that of sun_profile; empty where the sun is patches
std::vector<float> annual_profile(const DaylightMatrix& matrix, const std::vector<SkyHour>& hours,
                                  const std::vector<weather::SkyPatch>& patches,
                                  const std::vector<float>& sun);

}  // namespace photile::daylight
