// How much a glare source disturbs by where it lies in the field of view.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "photile/scene.hpp"

namespace photile::glare {

/// Somebody who looks somewhere.
struct Observer {
  std::string name;
  glm::dvec3 position{0.0};            ///< of the eyes, metres in the scene file's world
  glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit
  glm::dvec3 up{0.0, 1.0, 0.0};        ///< unit, at a right angle to `forward`

  /// With the up that is nearest to `upwards`, or any where that is along `forward`.
  static Observer looking(std::string name, const glm::dvec3& position, const glm::dvec3& forward,
                          const glm::dvec3& upwards);
};

/// The observer in the scene's own coordinates.
Observer in_scene(const Scene& scene, Observer observer);

/// Guth's position index of a direction (unit), by Levin's formula: with sigma the angle to the
/// line of sight and tau the angle between the vertical and the plane of both, in degrees,
///
///   ln p = (35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) sigma / 10^3
///        + (21 + 0.26667 tau - 0.002963 tau^2) sigma^2 / 10^5
///
/// (IESNA Lighting Handbook; the values of CIE 117:1995, table 4.1). Below the line of sight, where
/// Guth did not measure, that of Iwata and Osterhaus (CIE x035:2010):
/// ln p = 6.49 beta / 10^3 + 21 beta^2 / 10^5 with tan beta = tan sigma sqrt(1 + 0.3225 cos^2 tau).
/// Infinite for what is not in front of the eyes.
double position_index(const Observer& observer, const glm::dvec3& direction);

}  // namespace photile::glare
