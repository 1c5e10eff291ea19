// The sun and the sky that options ask for, once their place, time and weather are known.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "photile/scene.hpp"
#include "weather/perez_sky.hpp"

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

/// Errors: UsageError where one option lacks another; those of read_weather.
SkySituationLights sun_and_sky(const SceneLoadOptions& options);

}  // namespace photile::loading
