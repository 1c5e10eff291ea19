// Discomfort glare as one number, from glare sources, where they lie in the field of view, and what
// surrounds them.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "photile/scene.hpp"

namespace photile::glare {

struct Source {
  double luminance = 0;       ///< cd/m2, towards the eye
  double solid_angle = 0;     ///< sr, seen from it
  double position_index = 1;  ///< Guth's p
};

/// Unified glare rating (CIE 117:1995): 8 log10(0.25 / L_b sum L^2 omega / p^2). From 10 (hardly
/// noticed) to 28 (intolerable) where it means anything. -infinity without sources.
///   background   cd/m2: the indirect illuminance at the eye over pi
double ugr(std::span<const Source> sources, double background);

/// A source smaller than 0.005 m2 in projection counts as one of that area with its intensity
/// (CIE 147:2002, small sources): L^2 omega = 200 I^2 / r^2.
///   projected_area   m2, > 0
Source as_small_source(Source source, double projected_area);

/// Great-room glare rating, for sources larger than 1.5 m2 (CIE 147:2002, large sources):
/// UGR + (1.18 - 0.18 / CC) 8 log10(2.55 (1 + E_d / 220) / (1 + E_d / E_i)).
///   direct, indirect   lux at the eye, from the sources and from all else
///   coverage           CC: the area of the sources over that of the ceiling; 0.15 to 1 count
double ggr(double ugr, double direct, double indirect, double coverage);

/// Daylight glare probability (Wienold and Christoffersen 2006), at most 1:
/// 5.87e-5 E_v + 0.0918 log10(1 + sum L^2 omega / (E_v^1.87 p^2)) + 0.16.
///   illuminance   E_v, lux at the eye
double dgp(std::span<const Source> sources, double illuminance);

/// The factor on that where it is dark: e^(0.024 E_v - 4) / (1 + e^(0.024 E_v - 4)) (Wienold 2012);
/// 1 from 1000 lux on.
double low_light_correction(double illuminance);

/// Daylight glare index (Hopkinson 1972; the solid angle weighed by the position index):
/// 10 log10(0.478 sum L^1.6 (omega / p^2)^0.8 / (L_b + 0.07 omega^0.5 L)).
double dgi(std::span<const Source> sources, double background);

/// An observer who looks in one direction.
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
