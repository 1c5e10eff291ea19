// Where the sun stands in the sky of a place.
#pragma once

#include "photile/light_options.hpp"

namespace photile::weather {

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

}  // namespace photile::weather
