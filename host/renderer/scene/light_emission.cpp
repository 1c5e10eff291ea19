#include "scene/light_emission.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "photile/scene.hpp"
#include "scene/emission_cells.hpp"

namespace photile::scene {

bool set_light_color(const glm::dvec3& rgb, Light& light, double& luminance_of_rgb) {
  const glm::dvec3 positive = glm::max(rgb, glm::dvec3(0.0));
  luminance_of_rgb = luminance(positive);
  if (!std::isfinite(luminance_of_rgb) || luminance_of_rgb <= 0.0) return false;
  light.color = glm::vec3(positive / luminance_of_rgb);
  return true;
}

bool set_textured_emission(const Scene& scene, Light& light) {
  // Radiance times area in place of radiance.
  double bright = 0;
  if (!set_light_color(EmissionCells(scene, light).integral(), light, bright)) return false;
  light.power = area_flux(bright, 1.0, light.two_sided);
  light.texel_radiance = glm::vec3(glm::dvec3(light.texel_radiance) / light.power);
  return true;
}

double distant_flux(double irradiance, double angular_diameter, double radius) {
  // A disc of radiance L makes L pi sin^2 on a surface that faces it, while the flux counts its
  // solid angle L 2 pi (1 - cos).
  return directional_flux(irradiance, radius) * 2.0 / (1.0 + std::cos(0.5 * angular_diameter));
}

void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene) {
  Light light;
  light.name = name;
  light.kind = LightKind::environment;
  double bright = 0;
  set_light_color(map.integral(), light, bright);
  light.power = directional_flux(bright, bounding_sphere(scene).radius);
  light.environment = static_cast<std::uint32_t>(scene.environments.size());
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(std::move(light));
}

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
