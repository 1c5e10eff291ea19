// Emitted flux of each kind of light, in closed form. SI units: radiance (or luminance) per square
// metre and steradian, intensity per steradian, irradiance per square metre; lengths in metres.
#pragma once

namespace photile::scene {

/// Flux of a surface of `area` that emits `radiance` uniformly over the hemisphere of each side.
double area_flux(double radiance, double area, bool two_sided);

/// Flux of a point light of uniform `intensity`.
double point_flux(double intensity);

/// Flux of a spot light as KHR_lights_punctual defines it: `intensity` up to the inner cone angle,
/// then the square of a ramp that is linear in the cosine, zero from the outer cone angle on.
/// Angles in radians from the axis, 0 <= inner <= outer <= pi/2.
double spot_flux(double intensity, double inner_cone_angle, double outer_cone_angle);

/// Flux of parallel light of `irradiance` through a disc of `radius` that faces it.
double directional_flux(double irradiance, double radius);

}  // namespace photile::scene
