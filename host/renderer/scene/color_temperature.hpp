// The colour of light by its temperature.
#pragma once

#include <glm/glm.hpp>

namespace photile::scene {

/// CIE 1931 chromaticity (x, y) of light of a correlated colour temperature in kelvin, from
/// limits::min_color_temperature to limits::max_color_temperature: the reference illuminants of
/// ANSI/IES TM-30. Up to 4000 K a black body (Krystek 1985, within 1e-4), from 5000 K CIE daylight
/// (CIE 15, extrapolated above 25000 K), between them a mix.
glm::dvec2 chromaticity_of_temperature(double kelvin);

/// Linear Rec.709 of that light at luminance 1. Below about 1900 K its blue lies outside the gamut
/// and is 0.
glm::dvec3 color_of_temperature(double kelvin);

}  // namespace photile::scene
