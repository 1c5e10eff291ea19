#include "trace/direct_light.hpp"

#include <glm/gtc/constants.hpp>

#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/receiver.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {
namespace {

/// Panes and cutouts that a ray may pass on its way to a light: each takes it on, but for rounding.
constexpr int most_passed = 4096;

class DirectLight {
 public:
  DirectLight(const RayScene& rays, const LightSampler& lamps, const SurfacePoint& point,
              const Receiver& receiver, float share, std::vector<ReceivedLight>& found)
      : rays_(rays),
        scene_(rays.scene()),
        lamps_(lamps),
        point_(point),
        receiver_(receiver),
        share_(share),
        found_(found) {}

  void sample_light(const LightSampleNumbers::Look& look) {
    const auto lamp = lamps_.sample(point_.position, look.lamp, look.place);
    if (!lamp || !(glm::dot(lamp->direction, point_.normal) > 0.0f)) return;
    const glm::vec3 arrives =
        lamp->received * transmittance(rays_, point_.origin_towards(lamp->direction), lamp->target);
    if (arrives == glm::vec3(0.0f)) return;
    const float weight = lamp->weight_beside(receiver_.density(lamp->direction));
    add(lamp->layer, receiver_.weights(lamp->direction) * (arrives * weight));
  }

  /// Follows a direction through panes and cutouts until it meets a light, or what bends or stops
  /// it.
  void follow_direction(const LightSampleNumbers::Look& look) {
    const auto direction = receiver_.sample(look.lobe, look.direction);
    if (!direction) return;
    const float density = receiver_.density(*direction);
    if (!(density > 0.0f)) return;
    LightWeights weights = receiver_.weights(*direction) * glm::vec3(1.0f / density);
    glm::vec3 origin = point_.origin_towards(*direction);
    for (int surfaces = 0; surfaces <= most_passed; ++surfaces) {
      const auto hit = intersect(rays_, origin, *direction);
      if (!hit) {
        add_what_lies_beyond(*direction, density, weights);
        return;
      }
      const SurfacePoint met = surface_hit(scene_, *hit, *direction);
      if (emits(scene_, met)) {
        const std::uint32_t light = scene_.triangle_light[met.where.triangle];
        const float weight = power_heuristic(density, lamps_.density(point_.position, met));
        add(lamps_.layer(light), weights * (weight * lamps_.radiance(met, -*direction)));
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
    lamps_.distant().for_each_shining(
        direction, [&](const DistantLight& light, const glm::vec3& radiance) {
          const float weight =
              power_heuristic(density, lamps_.density(light, point_.position, direction));
          add(lamps_.layer(light.light()), weights * (weight * radiance));
        });
  }

  void add(std::uint32_t layer, const LightWeights& light) {
    found_.push_back({layer, share_ * light.irradiance, share_ * light.radiance});
  }

  const RayScene& rays_;
  const Scene& scene_;
  const LightSampler& lamps_;
  const SurfacePoint& point_;
  const Receiver& receiver_;
  float share_;
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

LightNumbers LightSampleNumbers::lamp(std::uint32_t number) const {
  const glm::uvec2 choices = sobol_words(first_ + number, scrambles_[0]);
  const glm::uvec2 place = sobol_words(first_ + number, scrambles_[1]);
  // A choice among many takes more than 32 bits: all looks share what follows.
  return {RandomBlock({choices.x, scrambles_[0].word(3), 0, 0}),
          RandomBlock({choices.y, scrambles_[1].word(3), place.x, place.y})};
}

LightSampleNumbers::Look LightSampleNumbers::look(std::uint32_t number) const {
  const glm::uvec2 direction = sobol_words(first_ + number, scrambles_[2]);
  const glm::uvec2 lobe = sobol_words(first_ + number, scrambles_[3]);
  return {lamp(number), RandomBlock({lobe.x, 0, 0, 0}),
          RandomBlock({lobe.y, direction.x, direction.y, 0})};
}

void find_direct_light(const RayScene& rays, const LightSampler& lamps, const SurfacePoint& point,
                       const glm::vec3& direction, ReflectedPart part, int count,
                       const LightSampleNumbers& samples, std::vector<ReceivedLight>& found) {
  OpaqueBsdf bsdf(rays.scene(), point, direction);
  bsdf.shade_smoothly(rays.scene(), point);
  if (part == ReflectedPart::but_the_base) bsdf.drop_diffuse();
  if (part == ReflectedPart::but_the_lobe) bsdf.drop_lobe();
  const Receiver receiver(point, bsdf);
  DirectLight light(rays, lamps, point, receiver, 1.0f / static_cast<float>(count), found);
  for (std::uint32_t number = 0; number < static_cast<std::uint32_t>(count); ++number) {
    const LightSampleNumbers::Look look = samples.look(number);
    light.sample_light(look);
    light.follow_direction(look);
  }
}

void ShadowRays::clear() {
  lines_.clear();
  found_.clear();
}

void ShadowRays::add(const LightSampler& lamps, const SurfacePoint& point,
                     const LightNumbers& numbers, const glm::vec3& weight, float directions,
                     const SelectionProbabilities& probabilities, std::uint32_t tag) {
  const auto lamp = lamps.sample(point.position, numbers.lamp, numbers.place, probabilities);
  if (!lamp) return;
  const float cosine = glm::dot(lamp->direction, point.normal);
  if (!(cosine > 0.0f)) return;
  const glm::vec3 arrives = cosine * weight * lamp->received *
                            lamp->weight_beside(directions * cosine * glm::one_over_pi<float>());
  if (arrives == glm::vec3(0.0f)) return;
  lines_.push_back({point.origin_towards(lamp->direction), lamp->target});
  found_.push_back({tag, lamp->layer, arrives, lamp->direction});
}

std::span<const ShadowRays::Found> ShadowRays::found(const RayScene& rays) {
  hidden_.resize(lines_.size());
  occluded(rays, lines_, hidden_);
  std::size_t left = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    Found light = found_[i];
    if (hidden_[i] != 0) {
      if (!rays.needs().see_through) continue;
      light.irradiance *= transmittance(rays, lines_[i].from, lines_[i].to);
      if (light.irradiance == glm::vec3(0.0f)) continue;
    }
    found_[left++] = light;
  }
  return std::span(found_).first(left);
}

}  // namespace photile::trace
