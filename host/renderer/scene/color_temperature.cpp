#include "scene/color_temperature.hpp"

#include <algorithm>

#include "photile/scene.hpp"

namespace photile::scene {
namespace {

/// Krystek, "An algorithm to calculate correlated colour temperature", 1985.
glm::dvec2 black_body(double t) {
  const double u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
                   (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
  const double v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
                   (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
  const double scale = 2 * u - 8 * v + 4;  // from CIE 1960 (u, v)
  return {3 * u / scale, 2 * v / scale};
}

glm::dvec2 daylight(double t) {
  const double x = t <= 7000 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                             : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
  return {x, (-3 * x + 2.870) * x - 0.275};
}

}  // namespace

glm::dvec2 chromaticity_of_temperature(double kelvin) {
  const double share = std::clamp((kelvin - 4000) / 1000, 0.0, 1.0);  // of daylight
  return glm::mix(black_body(kelvin), daylight(std::max(kelvin, 4000.0)), share);
}

glm::dvec3 color_of_temperature(double kelvin) {
  const glm::dvec2 xy = chromaticity_of_temperature(kelvin);
  const double x = xy.x / xy.y, z = (1 - xy.x - xy.y) / xy.y;  // Y = 1
  const glm::dvec3 rgb(3.2404542 * x - 1.5371385 - 0.4985314 * z,
                       -0.9692660 * x + 1.8760108 + 0.0415560 * z,
                       0.0556434 * x - 0.2040259 + 1.0572252 * z);
  const glm::dvec3 inside = glm::max(rgb, glm::dvec3(0.0));
  return inside / luminance(inside);
}

}  // namespace photile::scene
