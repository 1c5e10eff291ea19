// Form factors in closed form, double precision: what the analytic cases are computed from.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace photile::validation {

/// Factor from a small surface at `point` with unit `normal` to a polygon that lies above its
/// horizon, in [0, 1]: irradiance from the polygon over pi times its radiance. Corners
/// counter-clockwise as seen from the point give a positive value (Lambert, Photometria, 1760; in
/// vectors: Baum, Rushmeier and Winget, "Improving radiosity solutions through the use of
/// analytically determined form-factors", 1989).
double polygon_factor(const glm::dvec3& point, const glm::dvec3& normal,
                      std::span<const glm::dvec3> corners);

/// The absolute value of the above for the parallelogram origin, origin + u, origin + u + v,
/// origin + v.
double rectangle_factor(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& origin,
                        const glm::dvec3& u, const glm::dvec3& v);

/// Factor between equal, opposed rectangles of sides `a` and `b` at distance `c`, metres (Howell,
/// "A catalog of radiation heat transfer configuration factors", C-11).
double opposed_rectangles_factor(double a, double b, double c);

/// Factor from a rectangle of depth `w` to one of height `h` at a right angle to it, with the
/// common edge `l`, metres (the same catalog, C-14).
double perpendicular_rectangles_factor(double w, double h, double l);

/// Luminance along the normal over the luminance of uniform surroundings: the integral of
/// f (n.i) over the hemisphere, for albedo and F0 of one channel, F90 = 1 and GGX `alpha`. Relative
/// error below 1e-5.
double glossy_reflectance(double albedo, double f0, double alpha);

}  // namespace photile::validation
