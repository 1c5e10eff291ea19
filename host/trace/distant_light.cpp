#include "trace/distant_light.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/light_groups.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

bool sees_disc(const Light& sun, const glm::vec3& direction) {
  // By the sine: near 1 a cosine of floats could not tell the disc's border.
  const glm::dvec3 seen(direction), centre(-sun.direction);
  return glm::dot(seen, centre) > 0 &&
         glm::length(glm::cross(seen, centre)) <
             std::sin(0.5 * static_cast<double>(sun.angular_diameter));
}

double disc_solid_angle(const Light& sun) {
  const double half_sine = std::sin(0.25 * static_cast<double>(sun.angular_diameter));
  return 4 * glm::pi<double>() * half_sine * half_sine;  // 2 pi (1 - cos)
}

DistantLight::DistantLight(const Scene& scene, std::uint32_t light, double share, double radius)
    : lamp_(&scene.lights[light]), light_(light) {
  const double disc = glm::pi<double>() * radius * radius;  // that each direction's light crosses
  if (lamp_->kind == LightKind::environment) {
    map_ = &scene.environments[lamp_->environment];
    factor_ = glm::vec3(static_cast<float>(share / (disc * luminance(map_->integral()))));
  } else {
    factor_ = glm::vec3(glm::dvec3(lamp_->color) * share / (disc * disc_solid_angle(*lamp_)));
  }
}

glm::vec3 DistantLight::radiance(const glm::vec3& direction) const {
  if (map_ != nullptr) return factor_ * map_->radiance(direction);
  return sees_disc(*lamp_, direction) ? factor_ : glm::vec3(0.0f);
}

std::vector<DistantLight> distant_lights(const Scene& scene) {
  std::vector<DistantLight> found;
  const LightGroups groups = light_groups_of(scene);
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.has_size() && light.kind != LightKind::area)
      found.emplace_back(scene, i, groups.share[i], bounding_sphere(scene).radius);
  }
  return found;
}

DistantSampler::DistantSampler(const Scene& scene, const Light& light) : light_(&light) {
  if (light.kind == LightKind::environment) map_.emplace(scene.environments[light.environment]);
}

DistantSampler::Sample DistantSampler::sample(const RandomBlock& random) const {
  if (map_) return map_->sample(random);
  const double half_sine = std::sin(0.25 * static_cast<double>(light_->angular_diameter));
  const double below_one = random.uniform_double(0) * 2 * half_sine * half_sine;  // 1 - cosine
  const double sine = std::sqrt(below_one * (2 - below_one));
  const double phi = glm::two_pi<double>() * random.uniform(2);
  const Frame frame(-light_->direction);
  const glm::vec3 direction =
      frame.to_world(glm::vec3(sine * std::cos(phi), sine * std::sin(phi), 1 - below_one));
  return {glm::normalize(direction), light_->color,
          static_cast<float>(1 / disc_solid_angle(*light_))};
}

float DistantSampler::density(const glm::vec3& direction) const {
  if (map_) return map_->density(direction);
  return sees_disc(*light_, direction) ? static_cast<float>(1 / disc_solid_angle(*light_)) : 0.0f;
}

}  // namespace photile::trace
