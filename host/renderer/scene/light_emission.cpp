#include "scene/light_emission.hpp"

#include <cmath>
#include <utility>

#include "scene/emission_cells.hpp"
#include "scene/photometry.hpp"

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

}  // namespace photile::scene
