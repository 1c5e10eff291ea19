// Skies of daylight models.
#pragma once

#include <glm/glm.hpp>

#include "photile/environment_map.hpp"
#include "photile/light_options.hpp"
#include "weather/perez_sky.hpp"

namespace photile::loading {

/// A sky that gives `illuminance` on a horizontal surface, black below the horizon, white.
///   to_sun  unit; of a clear sky, whose own light includes no disc of the sun
/// Overcast: L = Lz (1 + 2 sin(elevation)) / 3 (Moon and Spencer 1942), so that the illuminance is
/// 7 pi Lz / 9. Clear: type 12 of ISO 15469 (CIE S 011), clear with low turbidity.
/// Perez: see PerezSky.
///   perez   of a Perez sky
EnvironmentMap sky_map(SkyKind kind, double illuminance, const glm::dvec3& to_sun,
                       const weather::PerezSky* perez = nullptr);

/// Unit direction towards a sun: north is -z, east +x, up +y.
glm::dvec3 direction_to(const Sun& sun);

}  // namespace photile::loading
