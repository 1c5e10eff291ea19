#include "scene/photometry.hpp"

#include <cmath>
#include <numbers>

namespace photile::scene {

using std::numbers::pi;

double area_flux(double radiance, double area, bool two_sided) {
  return pi * area * radiance * (two_sided ? 2.0 : 1.0);
}

double point_flux(double intensity) { return 4.0 * pi * intensity; }

double spot_flux(double intensity, double inner_cone_angle, double outer_cone_angle) {
  const double inner = std::cos(inner_cone_angle);
  const double outer = std::cos(outer_cone_angle);
  // 2 pi times the integral over the cosine: 1 on the inner cap, and the mean of t^2 is 1/3 on the
  // ramp.
  return 2.0 * pi * intensity * ((1.0 - inner) + (inner - outer) / 3.0);
}

double directional_flux(double irradiance, double radius) {
  return irradiance * pi * radius * radius;
}

}  // namespace photile::scene
