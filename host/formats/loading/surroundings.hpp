// The surroundings of a scene by its options: a picture, the sun, the sky of a site and an hour.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"

namespace photile::loading {

struct SkyLight {
  SkyKind kind = SkyKind::overcast;
  double illuminance = 0;                       ///< lux on open ground
  glm::dvec3 to_sun{0.0, 1.0, 0.0};             ///< unit, in the scene
  std::optional<weather::PerezSky> perez = {};  ///< of a Perez sky
  int patches = 0;
  double north = 0;  ///< radians clockwise from -z
};

struct SkySituationLights {
  std::optional<Sun> sun;  ///< its azimuth counts from -z
  std::optional<SkyLight> sky;
};

/// With the weather of a file, the sun is that of the middle of the hour that the row covers.
/// Errors: UsageError where one option lacks another; those of read_weather.
SkySituationLights sun_and_sky(const SceneLoadOptions& options);

/// The reflectance of the ground that a sky or a sun of the options lights; none without these.
std::optional<double> ground_reflectance(const SceneLoadOptions& options);

/// What every result states of the sky: "ground" and its reflectance, "weather" and the row of the
/// file that was taken. Empty without a sky or a sun of the options. Errors: those of read_weather.
std::vector<std::pair<std::string, std::string>> sky_facts(const SceneLoadOptions& options);

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

/// Adds the lights "environment", "sun", "sky" and "ground" that the options ask for; triangles
/// must be there. Errors: InputError for a picture that is missing, malformed, not in floating
/// point, black or has texels that are NaN, infinite or negative; UsageError for a clear sky
/// without a sun above the horizon, and for a ground other than the default that nothing lights or
/// where patches have their own.
void add_surroundings(Scene& scene, const SceneLoadOptions& options);

// The sky of another hour for a picture whose sky is patches.

/// The patches that lights of a mix are; none where they are no whole sky.
std::vector<weather::SkyPatch> patches_of(const LightMix& mix);

/// For each light of a mix the number of the patch that it is, or none; the ground has the last.
std::vector<std::uint32_t> patch_of_layers(const LightMix& mix);

/// The name of a light of sky_luminances: a patch, or the ground.
std::string sky_light_name(std::size_t light, std::size_t patches);

/// Changes that give each patch of a picture the luminance of the situation's Perez sky, and the
/// four patches nearest to the sun its light. The sky is that of the weather file's hour unless one
/// is given, and a clear one where neither is; the patches know where north is.
/// Errors: UsageError where the picture has no patches (the remedy says how to render some), or
/// where the site, the time or the sky is missing; those of read_weather.
std::vector<LightChange> sky_changes(const LightMix& mix, const SkySituation& situation,
                                     const std::optional<Sky>& sky);

}  // namespace photile::loading
