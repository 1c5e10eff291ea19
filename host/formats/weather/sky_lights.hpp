// Patches of the sky as lights of a scene, a layer each.
#pragma once

#include <string>
#include <vector>

#include "photile/scene.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"
#include "weather/sun_position.hpp"

namespace photile::weather {

/// "sky_0001" and so on; "ground" is what lies below the horizon.
std::string patch_name(std::size_t patch);

/// Adds a light for each patch, even and white, and one for the ground below the horizon. Each has
/// the power that it has at 1 cd/m2 (or W/(m2 sr)). Returns the number of the first.
///   north   radians clockwise from -z
std::size_t add_sky_lights(const std::vector<SkyPatch>& patches, double north, Scene& scene);

/// Luminances of these lights, cd/m2, the ground last: those of a Perez sky, the sun in the four
/// patches nearest to it, and a ground of defaults::ground_reflectance that both light.
///   day   of the year, from 1
std::vector<double> sky_luminances(const std::vector<SkyPatch>& patches, const SunPosition& sun,
                                   const SkyIrradiance& irradiance, int day);

/// Flux that a patch of this solid angle and 1 cd/m2 sends through the disc of the scene's bounding
/// sphere.
double patch_flux(const Scene& scene, double solid_angle);

}  // namespace photile::weather
