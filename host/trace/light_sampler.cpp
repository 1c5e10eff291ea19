#include "trace/light_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "photile/primary_hits.hpp"
#include "trace/photon_quota.hpp"
#include "trace/spot_falloff.hpp"

namespace photile::trace {

LightSampler::LightSampler(const Scene& scene)
    : scene_(&scene),
      groups_(light_groups_of(scene)),
      bounds_(bounding_sphere(scene)),
      radiance_(emitted_radiance_at_unit_power(scene)) {
  double sum = 0;
  for (const double share : light_shares(scene.lights, PhotonQuota::balanced)) {
    chance_up_to_.push_back(sum += share);
  }
  for (const Light& light : scene.lights) {
    const bool area = light.kind == LightKind::area;
    area_of_.push_back(area ? static_cast<std::uint32_t>(areas_.size()) : none);
    if (area) areas_.emplace_back(scene, light);
  }
}

float LightSampler::chance(std::uint32_t light) const {
  const double before = light == 0 ? 0.0 : chance_up_to_[light - 1];
  return static_cast<float>((chance_up_to_[light] - before) / chance_up_to_.back());
}

std::optional<LightSample> LightSampler::sample(const glm::vec3& position,
                                                const RandomBlock& choice,
                                                const RandomBlock& place) const {
  // The last entry is larger than the target, so there always is one.
  const double target = choice.uniform_double(0) * chance_up_to_.back();
  const auto light = static_cast<std::uint32_t>(
      std::upper_bound(chance_up_to_.begin(), chance_up_to_.end(), target) - chance_up_to_.begin());
  switch (scene_->lights[light].kind) {
    case LightKind::area:
      return towards_area(light, position, place);
    case LightKind::directional:
      return towards_sky(light, position);
    default:
      return towards_point(light, position);
  }
}

std::optional<LightSample> LightSampler::towards_area(std::uint32_t light,
                                                      const glm::vec3& position,
                                                      const RandomBlock& place) const {
  const TriangleHit where = areas_[area_of_[light]].sample(place);
  const SurfacePoint front = surface_point(*scene_, where, scene_->front_side[where.triangle]);
  const SurfacePoint point = surface_hit(*scene_, where, glm::normalize(front.position - position));
  if (!emits(*scene_, point)) return std::nullopt;
  const float seen = density(position, point);
  if (!(seen > 0.0f) || !(seen < std::numeric_limits<float>::infinity())) return std::nullopt;
  const glm::vec3 direction = glm::normalize(point.position - position);
  return LightSample{groups_.group_of[light], direction, point.origin_towards(-direction),
                     radiance_[light] / seen, seen};
}

std::optional<LightSample> LightSampler::towards_point(std::uint32_t light,
                                                       const glm::vec3& position) const {
  const Light& lamp = scene_->lights[light];
  const glm::dvec3 offset = glm::dvec3(lamp.position) - glm::dvec3(position);
  const double squared_distance = glm::dot(offset, offset);
  if (!(squared_distance > 0)) return std::nullopt;
  const glm::dvec3 direction = offset / std::sqrt(squared_distance);
  double intensity = 0.25 * glm::one_over_pi<double>();  // candela for each lumen
  if (lamp.kind == LightKind::spot) {
    const SpotFalloff spot(lamp);
    intensity = spot.at(-glm::dot(direction, glm::dvec3(lamp.direction))) /
                (glm::two_pi<double>() * spot.integral());
  }
  if (!(intensity > 0)) return std::nullopt;
  return LightSample{groups_.group_of[light], glm::vec3(direction), lamp.position,
                     glm::vec3(glm::dvec3(lamp.color) * groups_.share[light] * intensity /
                               (squared_distance * double{chance(light)})),
                     0.0f};
}

LightSample LightSampler::towards_sky(std::uint32_t light, const glm::vec3& position) const {
  const Light& lamp = scene_->lights[light];
  // Its flux falls on the disc of the bounding sphere, which the line of sight leaves.
  const double disc = glm::pi<double>() * bounds_.radius * bounds_.radius;
  return {groups_.group_of[light], -lamp.direction,
          position - static_cast<float>(2.5 * bounds_.radius) * lamp.direction,
          glm::vec3(glm::dvec3(lamp.color) * groups_.share[light] / (disc * double{chance(light)})),
          0.0f};
}

float LightSampler::density(const glm::vec3& position, const SurfacePoint& emitting) const {
  const std::uint32_t light = scene_->triangle_light[emitting.where.triangle];
  const glm::vec3 offset = emitting.position - position;
  const float squared_distance = glm::dot(offset, offset);
  const float cosine = -glm::dot(offset, emitting.normal) / std::sqrt(squared_distance);
  const auto area = static_cast<float>(areas_[area_of_[light]].area());
  return cosine > 0.0f ? chance(light) * squared_distance / (area * cosine) : 0.0f;
}

}  // namespace photile::trace
