// The position of the sun in the sky of a site, and the all-weather sky of Perez, Seals and
// Michalsky.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "photile/load_scene.hpp"

namespace photile::weather {

/// "north", "northeast", ...: the nearest of eight, clockwise from north.
std::string_view compass_point(double degrees);

/// True angles, without refraction.
struct SunPosition {
  double azimuth = 0;    ///< radians clockwise from north
  double elevation = 0;  ///< radians above the horizon
};

/// By the low-precision formulae of the Astronomical Almanac, within 0.01 degrees from 1950 to
/// 2050 (Michalsky, "The Astronomical Almanac's algorithm for approximate solar position", Solar
/// Energy 40(3), 1988). Time is the standard time of the site's zone.
SunPosition sun_position(const Site& site, const LocalTime& time);

/// Days from the start of the year, 1 for the first of January.
int day_of_year(const LocalTime& time);

/// What a weather station measures.
struct SkyIrradiance {
  double direct_normal = 0;       ///< W/m2 on a surface that faces the sun
  double diffuse_horizontal = 0;  ///< W/m2
  double dew_point = 11;          ///< degrees Celsius
};

/// Luminances by Perez, Seals and Michalsky, "All-weather model for sky luminance distribution",
/// Solar Energy 50(3), 1993, and its erratum, 51(5); luminous efficacies by Perez et al., "Modeling
/// daylight availability and irradiance components from direct and global irradiance", Solar Energy
/// 44(5), 1990. Clearness and brightness are kept in the ranges in which Radiance's gendaylit and
/// gendaymtx keep them.
class PerezSky {
 public:
  ///   sun_elevation   radians; below the horizon the sky is that of a sun on it
  ///   day             of the year, from 1
  PerezSky(double sun_elevation, const SkyIrradiance& irradiance, int day);

  double direct_illuminance() const { return direct_; }    ///< lux, facing the sun
  double diffuse_illuminance() const { return diffuse_; }  ///< lux, horizontal
  double clearness() const { return clearness_; }          ///< epsilon
  double brightness() const { return brightness_; }        ///< delta

  /// Luminance over a factor that is the same everywhere, not negative.
  ///   sine     of the elevation of the point in the sky, taken to be at least that of gendaylit
  ///   cosine   of the angle between it and the sun
  float relative_luminance(float sine, float cosine) const {
    return std::max(0.0f, gradation(sine) * indicatrix(cosine));
  }
  /// The two factors of that luminance.
  float gradation(float sine) const;
  float indicatrix(float cosine) const;

 private:
  double clearness_ = 1, brightness_ = 0.01;
  double direct_ = 0, diffuse_ = 0;
  std::array<double, 5> shape_{};  ///< a to e of equation 1
};

/// The sun's zenith angle as the model takes it, radians: never below the horizon, nor nearer than
/// three degrees to the zenith.
double zenith_of_sun(double sun_elevation);

/// Irradiances of a cloudless hour by the clear-sky model of ASHRAE (Handbook of Fundamentals, 1985
/// to 2005): direct normal A exp(-B / sin(elevation)), diffuse horizontal C times that, with the
/// coefficients of the 21st of each month, between which days are interpolated. The months are
/// those of the northern hemisphere; nothing below the horizon.
///   sun_elevation   radians
///   day             of the year, from 1
SkyIrradiance clear_sky(double sun_elevation, int day);

}  // namespace photile::weather
