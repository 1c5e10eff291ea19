#include "trace/direct_light.hpp"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "photile/defaults.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/shading_point.hpp"

namespace photile::trace {
namespace {

/// Panes and cutouts that a ray may pass on its way to a light: each moves the ray on, up to
/// rounding.
constexpr int most_passed = 4096;

/// The light from one part of a sun that nothing hides is no less than this part of that from
/// another.
constexpr double least_of_whole = 0.9;

class DirectLight {
 public:
  DirectLight(const RayScene& rays, const LightSampler& light_sampler, const SurfacePoint& point,
              const ShadingPoint& shading_point, float fraction, std::vector<ReceivedLight>& found)
      : rays_(rays),
        scene_(rays.scene()),
        light_sampler_(light_sampler),
        point_(point),
        shading_point_(shading_point),
        fraction_(fraction),
        found_(found) {}

  void sample_light(const LightSampleNumbers::Sample& light_sample) {
    const auto light =
        light_sampler_.sample(point_.position, light_sample.choice, light_sample.position);
    if (!light || !(glm::dot(light->direction, point_.normal) > 0.0f)) return;
    const glm::vec3 arrives =
        light->received *
        transmittance(rays_, point_.origin_towards(light->direction), light->target);
    if (arrives == glm::vec3(0.0f)) return;
    const float weight = light->weight_beside(shading_point_.density(light->direction));
    add(light->layer, shading_point_.weights(light->direction) * (arrives * weight));
  }

  /// Follows a direction through panes and cutouts until it meets a light, or what bends or stops
  /// it.
  void follow_direction(const LightSampleNumbers::Sample& light_sample) {
    const auto direction = shading_point_.sample(light_sample.lobe, light_sample.direction);
    if (!direction) return;
    const float density = shading_point_.density(*direction);
    if (!(density > 0.0f)) return;
    LightWeights weights = shading_point_.weights(*direction) * glm::vec3(1.0f / density);
    RayOrigin origin = point_.origin_towards(*direction);
    for (int surfaces = 0; surfaces <= most_passed; ++surfaces) {
      const auto hit = intersect(rays_, origin, *direction);
      if (!hit) {
        add_what_lies_beyond(*direction, density, weights);
        return;
      }
      const SurfacePoint met = surface_hit(scene_, *hit, *direction);
      if (emits(scene_, met)) {
        const std::uint32_t light = scene_.triangle_light[met.where.triangle];
        const float weight = power_heuristic(density, light_sampler_.density(point_.position, met));
        add(light_sampler_.layer(light),
            weights * (weight * light_sampler_.radiance(met, -*direction)));
      }
      const glm::vec3 passes = transmittance(scene_, met, *direction);
      if (passes == glm::vec3(0.0f)) return;
      weights = weights * passes;
      origin = met.origin_towards(*direction);
    }
  }

 private:
  void add_what_lies_beyond(const glm::vec3& direction, float density,
                            const LightWeights& weights) {
    light_sampler_.distant().for_each_shining(
        direction, [&](const DistantLight& light, const glm::vec3& radiance) {
          const float weight =
              power_heuristic(density, light_sampler_.density(light, point_.position, direction));
          add(light_sampler_.layer(light.light()), weights * (weight * radiance));
        });
  }

  void add(std::uint32_t layer, const LightWeights& light) {
    found_.push_back({layer, fraction_ * light.irradiance, fraction_ * light.radiance});
  }

  const RayScene& rays_;
  const Scene& scene_;
  const LightSampler& light_sampler_;
  const SurfacePoint& point_;
  const ShadingPoint& shading_point_;
  float fraction_;
  std::vector<ReceivedLight>& found_;
};

}  // namespace

LightSampleNumbers::LightSampleNumbers(const RandomStream& sequences, std::uint32_t first,
                                       std::uint32_t surface)
    : scrambles_{sequences.block(Purpose::direct_light, 4 * surface),
                 sequences.block(Purpose::direct_light, 4 * surface + 1),
                 sequences.block(Purpose::direct_light, 4 * surface + 2),
                 sequences.block(Purpose::direct_light, 4 * surface + 3)},
      first_(first) {}

LightNumbers LightSampleNumbers::light(std::uint32_t number) const {
  const glm::uvec2 choices = sobol_words(first_ + number, scrambles_[0]);
  const glm::uvec2 on_light = sobol_words(first_ + number, scrambles_[1]);
  // A choice among many takes more than 32 bits: all light samples share what follows.
  return {RandomBlock({choices.x, scrambles_[0].word(3), 0, 0}),
          RandomBlock({choices.y, scrambles_[1].word(3), on_light.x, on_light.y})};
}

LightSampleNumbers::Sample LightSampleNumbers::sample(std::uint32_t number) const {
  const glm::uvec2 direction = sobol_words(first_ + number, scrambles_[2]);
  const glm::uvec2 lobe = sobol_words(first_ + number, scrambles_[3]);
  return {light(number), RandomBlock({lobe.x, 0, 0, 0}),
          RandomBlock({lobe.y, direction.x, direction.y, 0})};
}

void find_direct_light(const RayScene& rays, const LightSampler& light_sampler,
                       const SurfacePoint& point, const glm::vec3& direction, ReflectedPart part,
                       int count, const LightSampleNumbers& samples,
                       std::vector<ReceivedLight>& found) {
  OpaqueBsdf bsdf(rays.scene(), point, direction);
  bsdf.shade_smoothly(rays.scene(), point);
  if (part == ReflectedPart::but_the_base) bsdf.drop_diffuse();
  if (part == ReflectedPart::but_the_lobe) bsdf.drop_lobe();
  const ShadingPoint shading_point(point, bsdf);
  DirectLight light(rays, light_sampler, point, shading_point, 1.0f / static_cast<float>(count),
                    found);
  for (std::uint32_t number = 0; number < static_cast<std::uint32_t>(count); ++number) {
    const LightSampleNumbers::Sample light_sample = samples.sample(number);
    light.sample_light(light_sample);
    light.follow_direction(light_sample);
  }
}

void ShadowRays::clear() {
  lines_.clear();
  origins_.clear();
  found_.clear();
}

void ShadowRays::add(const SurfacePoint& point, const std::optional<LightSample>& light,
                     const glm::vec3& weight, float directions, std::uint32_t tag) {
  if (!light) return;
  const float cosine = glm::dot(light->direction, point.normal);
  if (!(cosine > 0.0f)) return;
  const glm::vec3 arrives = cosine * weight * light->received *
                            light->weight_beside(directions * cosine * glm::one_over_pi<float>());
  if (arrives == glm::vec3(0.0f)) return;
  origins_.push_back(point.origin_towards(light->direction));
  lines_.push_back({origins_.back().position, light->target});
  found_.push_back({tag, light->layer, arrives, light->direction});
}

std::span<const ShadowRays::Found> ShadowRays::found(const RayScene& rays) {
  hidden_.resize(lines_.size());
  occluded(rays, lines_, hidden_);
  std::size_t left = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Found light = found_[i];
    if (hidden_[i] != 0 || origins_[i].next != none) {
      if (!rays.needs().see_through) continue;
      light.irradiance *= transmittance(rays, origins_[i], lines_[i].to);
      if (light.irradiance == glm::vec3(0.0f)) continue;
    }
    found_[left++] = light;
  }
  return std::span(found_).first(left);
}

std::optional<ShadowRays::Found> ShadowRays::light_of_sun(std::uint32_t light, const RayScene& rays,
                                                          const LightSampler& light_sampler,
                                                          const SurfacePoint& point) {
  constexpr std::uint32_t of_rim = 0, of_disc = 1;
  const auto sample = [&](const glm::dvec2& on_disc, std::uint32_t tag) {
    add(point, light_sampler.towards(light, point.position, on_disc), glm::vec3(1.0f), 0.0f, tag);
  };
  const auto sample_disc = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      sample(sobol_point(static_cast<std::uint32_t>(i), RandomBlock({})), of_disc);
    }
  };
  const auto brightness = [](const Found& part) { return luminance(glm::dvec3(part.irradiance)); };
  clear();
  for (int i = 0; i < defaults::sun_rim_samples; ++i) {
    sample({0x1.fffffep-1, (i + 0.5) / defaults::sun_rim_samples}, of_rim);
  }
  sample_disc(0, defaults::sun_samples);
  Found sum{};
  const auto add_to_sum = [&](std::span<const Found> samples) {
    for (const Found& part : samples) {
      if (part.tag == of_rim) continue;
      sum.irradiance += part.irradiance;
      sum.direction += static_cast<float>(brightness(part)) * part.direction;
      sum.layer = part.layer;
    }
  };
  const std::span<const Found> all = found(rays);
  if (all.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(
      all.begin(), all.end(),
      [&](const Found& a, const Found& b) { return brightness(a) < brightness(b); });
  const bool whole = all.size() == defaults::sun_rim_samples + defaults::sun_samples &&
                     brightness(*least) > least_of_whole * brightness(*most);
  add_to_sum(all);
  int count = defaults::sun_samples;
  if (!whole) {
    clear();
    sample_disc(count, defaults::hidden_sun_samples);
    add_to_sum(found(rays));
    count = defaults::hidden_sun_samples;
  }
  if (sum.irradiance == glm::vec3(0.0f)) return std::nullopt;
  sum.irradiance /= static_cast<float>(count);
  sum.direction = glm::normalize(sum.direction);
  return sum;
}

}  // namespace photile::trace
