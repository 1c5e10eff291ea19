// A sky without clouds, for where no weather is given.
#pragma once

#include "weather/perez_sky.hpp"

namespace photile::weather {

/// Irradiances of a cloudless hour by the clear-sky model of ASHRAE (Handbook of Fundamentals, 1985
/// to 2005): direct normal A exp(-B / sin(elevation)), diffuse horizontal C times that, with the
/// coefficients of the 21st of each month, between which days are interpolated. The months are
/// those of the northern hemisphere; nothing below the horizon.
///   sun_elevation   radians
///   day             of the year, from 1
SkyIrradiance clear_sky(double sun_elevation, int day);

}  // namespace photile::weather
