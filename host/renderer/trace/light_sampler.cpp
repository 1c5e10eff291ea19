#include "trace/light_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/ray_scene.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/light_clusters.hpp"

namespace photile::trace {

namespace {

bool is_sun(const Light& light) {
  return light.kind == LightKind::directional && light.angular_diameter > 0.0f &&
         light.angular_diameter <= defaults::largest_sun && !light.is_sky_patch();
}

std::vector<std::uint32_t> lights_sampled_apart(const Scene& scene) {
  std::vector<std::uint32_t> lights;
  // Where lights are not weighed, all are chosen from.
  if (scene.lights.size() > LightClusters::most_lights) return lights;
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    if (!scene.lights[light].has_size() || is_sun(scene.lights[light])) lights.push_back(light);
  }
  if (lights.size() > defaults::most_sampled_apart) lights.clear();
  return lights;
}

}  // namespace

LightSampler::LightSampler(const Scene& scene)
    : scene_(&scene),
      groups_(light_groups_of(scene)),
      bounds_(bounding_sphere(scene)),
      fraction_(light_fractions(scene.lights, PhotonQuota::balanced)),
      sampled_apart_(lights_sampled_apart(scene)),
      clusters_(scene, fraction_, bounds_, sampled_apart_),
      radiance_(emitted_radiance_at_unit_power(scene)),
      distant_(scene),
      portals_(scene),
      distant_of_(scene.lights.size(), none) {
  double sum = 0;
  for (const double fraction : fraction_) cumulative_fraction_.push_back(sum += fraction);
  for (const Light& light : scene.lights) {
    const bool area = light.kind == LightKind::area;
    area_of_.push_back(area ? static_cast<std::uint32_t>(areas_.size()) : none);
    if (area) areas_.emplace_back(scene, light);
  }
  double beyond = 0;
  for (const DistantLight& light : distant_) {
    distant_of_[light.light()] = static_cast<std::uint32_t>(distant_samplers_.size());
    distant_samplers_.emplace_back(scene, scene.lights[light.light()]);
    beyond += fraction_[light.light()];
  }
  if (!portals_.empty())
    portal_fraction_ = defaults::portal_sample_fraction * std::min(1.0, beyond);
}

/// The selection probability of a light that is chosen as a whole.
float LightSampler::probability(std::uint32_t light,
                                const SelectionProbabilities& probabilities) const {
  const double others = 1 - portal_fraction_;
  if (!probabilities.up_to.empty())
    return static_cast<float>(others * probabilities.of(clusters_.whole(light)));
  const double before = light == 0 ? 0.0 : cumulative_fraction_[light - 1];
  return static_cast<float>(others * (cumulative_fraction_[light] - before) /
                            cumulative_fraction_.back());
}

std::optional<LightSample> LightSampler::sample(const glm::vec3& position,
                                                const RandomBlock& chosen_by,
                                                const RandomBlock& on_light,
                                                const SelectionProbabilities& probabilities) const {
  RandomBlock choice = chosen_by;
  if (portal_fraction_ > 0) {
    const double number = chosen_by.uniform_double(0);
    if (number < portal_fraction_)
      return through_portal(number / portal_fraction_, position, on_light, probabilities);
    choice = RandomBlock::of(
        std::min((number - portal_fraction_) / (1 - portal_fraction_), 1 - 0x1p-53));
  }
  std::uint32_t light, triangle = none;
  if (probabilities.up_to.empty()) {
    // The last entry is larger than the target, so there always is one.
    const double target = choice.uniform_double(0) * cumulative_fraction_.back();
    light = static_cast<std::uint32_t>(
        std::upper_bound(cumulative_fraction_.begin(), cumulative_fraction_.end(), target) -
        cumulative_fraction_.begin());
  } else {
    const LightClusters::Choice chosen = clusters_.choose(probabilities, choice, on_light);
    light = chosen.light;
    triangle = chosen.triangle;
  }
  if (distant_of_[light] != none) return towards_distant(light, position, on_light, probabilities);
  if (scene_->lights[light].kind == LightKind::area) {
    const AreaSampler& area = areas_[area_of_[light]];
    return towards_area(
        light,
        triangle == none ? area.sample_front(on_light) : area.sample_front_of(triangle, on_light),
        position, probabilities);
  }
  return towards_light_without_size(light, position, double{probability(light, probabilities)});
}

/// Towards a point of the light.
std::optional<LightSample> LightSampler::towards_area(
    std::uint32_t light, SurfacePoint point, const glm::vec3& position,
    const SelectionProbabilities& probabilities) const {
  const glm::vec3 direction = glm::normalize(point.position - position);
  if (glm::dot(point.normal, direction) > 0.0f) {
    point.side = 1 - point.side;
    point.normal = -point.normal;
  }
  if (!emits(*scene_, point)) return std::nullopt;
  const float seen = density(position, point, probabilities);
  if (!(seen > 0.0f) || !(seen < std::numeric_limits<float>::infinity())) return std::nullopt;
  return LightSample{groups_.group_of[light], direction, point.origin_towards(-direction),
                     radiance_[light] * emission_towards(*scene_, point, -direction) / seen, seen};
}

/// Towards a light that is chosen with this probability.
std::optional<LightSample> LightSampler::towards_light_without_size(std::uint32_t light,
                                                                    const glm::vec3& position,
                                                                    double probability) const {
  const Light& source = scene_->lights[light];
  const glm::dvec3 color = glm::dvec3(source.color) * groups_.fraction[light];
  if (source.kind == LightKind::directional) {
    // Its flux falls on the disc of the bounding sphere, which the shadow ray leaves.
    const double disc = glm::pi<double>() * bounds_.radius * bounds_.radius;
    return LightSample{groups_.group_of[light],
                       -source.direction,
                       beyond(position, -source.direction),
                       glm::vec3(color / (disc * probability)),
                       0.0f,
                       true};
  }
  const glm::dvec3 offset = glm::dvec3(source.position) - glm::dvec3(position);
  const double squared_distance = glm::dot(offset, offset);
  if (!(squared_distance > 0)) return std::nullopt;
  const glm::dvec3 direction = offset / std::sqrt(squared_distance);
  const double intensity = candela_per_lumen(*scene_, source, -direction);
  if (!(intensity > 0)) return std::nullopt;
  return LightSample{groups_.group_of[light],
                     glm::vec3(direction),
                     source.position,
                     glm::vec3(color * intensity / (squared_distance * probability)),
                     0.0f,
                     false,
                     light};
}

std::optional<LightSample> LightSampler::towards(std::uint32_t light, const glm::vec3& position,
                                                 const glm::dvec2& on_disc) const {
  if (!is_sun(scene_->lights[light])) return towards_light_without_size(light, position, 1.0);
  const DistantSampler::Sample chosen =
      distant_samplers_[distant_of_[light]].sample(RandomBlock::of(on_disc.x).with(2, on_disc.y));
  const double disc = glm::pi<double>() * bounds_.radius * bounds_.radius;
  return LightSample{groups_.group_of[light],
                     chosen.direction,
                     beyond(position, chosen.direction),
                     glm::vec3(glm::dvec3(chosen.color) * groups_.fraction[light] / disc),
                     chosen.density,
                     true};
}

glm::vec3 LightSampler::beyond(const glm::vec3& position, const glm::vec3& direction) const {
  const double reach = glm::distance(glm::dvec3(position), bounds_.center) + 1.5 * bounds_.radius;
  return position + static_cast<float>(std::max(2.5 * bounds_.radius, reach)) * direction;
}

LightSample LightSampler::towards_distant(std::uint32_t light, const glm::vec3& position,
                                          const RandomBlock& on_light,
                                          const SelectionProbabilities& probabilities) const {
  const std::uint32_t index = distant_of_[light];
  const DistantSampler::Sample chosen = distant_samplers_[index].sample(on_light);
  const double disc = glm::pi<double>() * bounds_.radius * bounds_.radius;
  const float alone = probability(light, probabilities) * chosen.density;
  const float all = portal_fraction_ > 0
                        ? density(distant_[index], position, chosen.direction, probabilities)
                        : alone;
  // Density is in proportion to luminance, and both integrate to 1 over the sphere.
  return {groups_.group_of[light],
          chosen.direction,
          beyond(position, chosen.direction),
          glm::vec3(glm::dvec3(chosen.color) * groups_.fraction[light] * double{chosen.density} /
                    (disc * double{std::max(alone, all)})),
          std::max(alone, all),
          true};
}

const PortalSizes& LightSampler::portals_from(const glm::vec3& position,
                                              const SelectionProbabilities& probabilities) const {
  if (!probabilities.portals.solid_angle.empty()) return probabilities.portals;
  thread_local PortalSizes here;
  portals_.measure(glm::dvec3(position), here);
  return here;
}

std::optional<LightSample> LightSampler::through_portal(
    double number, const glm::vec3& position, const RandomBlock& on_light,
    const SelectionProbabilities& probabilities) const {
  const PortalSizes& portals = portals_from(position, probabilities);
  if (!(portals.sum > 0)) return std::nullopt;
  const glm::vec3 direction(
      portals_.sample_direction(glm::dvec3(position), portals, double{on_light.uniform(0)},
                                double{on_light.uniform(2)}, double{on_light.uniform(3)}));
  // One of the lights there, each as likely.
  thread_local std::vector<std::pair<const DistantLight*, glm::vec3>> there;
  there.clear();
  distant_.for_each_shining(direction, [](const DistantLight& light, const glm::vec3& radiance) {
    there.emplace_back(&light, radiance);
  });
  if (there.empty()) return std::nullopt;
  const auto count = static_cast<double>(there.size());
  const auto& [light, radiance] = there[static_cast<std::size_t>(number * count)];
  const float all = density(*light, position, direction, probabilities);
  if (!(all > 0.0f)) return std::nullopt;
  return LightSample{groups_.group_of[light->light()],
                     direction,
                     beyond(position, direction),
                     radiance / all,
                     all,
                     true};
}

float LightSampler::density(const DistantLight& light, const glm::vec3& position,
                            const glm::vec3& direction,
                            const SelectionProbabilities& probabilities) const {
  if (probabilities.but_apart &&
      std::binary_search(sampled_apart_.begin(), sampled_apart_.end(), light.light())) {
    return std::numeric_limits<float>::infinity();
  }
  const float alone = probability(light.light(), probabilities) *
                      distant_samplers_[distant_of_[light.light()]].density(direction);
  if (!(portal_fraction_ > 0)) return alone;
  const PortalSizes& portals = portals_from(position, probabilities);
  if (!(portals.sum > 0) || light.radiance(direction) == glm::vec3(0.0f)) return alone;
  const double through = portals_.density(glm::dvec3(position), glm::dvec3(direction), portals);
  if (!(through > 0)) return alone;
  double count = 0;
  distant_.for_each_shining(direction, [&](const DistantLight&, const glm::vec3&) { ++count; });
  return alone + static_cast<float>(portal_fraction_ * through / std::max(1.0, count));
}

float LightSampler::density(const glm::vec3& position, const SurfacePoint& emitting,
                            const SelectionProbabilities& probabilities) const {
  const std::uint32_t triangle = emitting.where.triangle;
  const std::uint32_t light = scene_->triangle_light[triangle];
  const glm::vec3 offset = emitting.position - position;
  const float squared_distance = glm::dot(offset, offset);
  const float cosine = -glm::dot(offset, emitting.normal) / std::sqrt(squared_distance);
  if (!(cosine > 0.0f)) return 0.0f;
  float chosen;  // per square metre
  if (probabilities.up_to.empty() || clusters_.whole(light) != none) {
    chosen = probability(light, probabilities) *
             static_cast<float>(areas_[area_of_[light]].density(emitting.where));
  } else {
    const std::uint32_t cluster = clusters_.cluster_of(triangle);
    chosen = static_cast<float>((1 - portal_fraction_) * probabilities.of(cluster) /
                                clusters_.area(cluster));
  }
  return chosen * squared_distance / cosine;
}

}  // namespace photile::trace
