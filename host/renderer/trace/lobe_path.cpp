#include "trace/lobe_path.hpp"

#include <algorithm>

#include "photile/defaults.hpp"
#include "trace/direct_light.hpp"
#include "trace/largest.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {
namespace {

/// A lamp as the lobe reflects it; also by how much the base reflects more or less of it than of
/// light from all sides, for hits say no more of the base.
void look_at_lamp(const EyeSetup& setup, const EyeEnd& end, const OpaqueBsdf& whole,
                  const OpaqueBsdf& lobe, const LookSamples::Look& look, EyeRecord& record) {
  const auto lamp = setup.lobes->lamps.sample(end.point.position, look.lamp, look.place);
  if (!lamp) return;
  glm::vec3 reflected = lobe.reflected(lamp->direction);
  if (lamp->density > 0.0f) {
    reflected *= power_heuristic(lamp->density, lobe.density(lamp->direction));
  }
  // Looks that bring the base all of its direct light know where it comes from.
  if (!setup.direct) reflected += whole.base_deviation(lamp->direction);
  glm::vec3 radiance = reflected * lamp->received;
  if (radiance == glm::vec3(0.0f)) return;
  radiance *=
      transmittance(setup.lobes->rays, end.point.origin_towards(lamp->direction), lamp->target);
  if (radiance == glm::vec3(0.0f)) return;
  record.direct.push_back({end.ray.pixel, lamp->layer, end.ray.radiance_weight() * radiance});
}

}  // namespace

void follow_lobes(const EyeSetup& setup, EyeEnd end, const PixelSample& sample, EyeRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const std::uint32_t first_stream =
      sample.ray * (static_cast<std::uint32_t>(setup.parameters->max_specular_depth) + 1);
  const auto looks_at_hits = static_cast<std::uint32_t>(setup.direct ? setup.direct->count : 1);
  glm::vec3 left(1.0f);  // of the light, since the first lobe
  for (int depth = 1; depth <= setup.parameters->max_specular_depth; ++depth) {
    const auto surface = static_cast<std::uint32_t>(2 * depth);
    OpaqueBsdf whole(scene, end.point, end.ray.direction);
    whole.shade_smoothly(scene, end.point);
    OpaqueBsdf lobe = whole;
    lobe.keep_lobe();
    const LookSamples::Look look = LookSamples(sample.of_pixel, sample.index, surface - 1).look(0);
    look_at_lamp(setup, end, whole, lobe, look, record);
    const auto direction = lobe.sample(look.direction);
    if (!direction) return;
    const float density = lobe.density(*direction);
    if (!(density > 0.0f)) return;
    glm::vec3 weight = lobe.reflected(*direction) / density;
    const float survival = std::min(1.0f, largest(left * weight) / defaults::least_lobe_weight);
    if (!(look.direction.uniform(choice_word) < survival)) return;  // no other use for the word
    weight /= survival;
    left *= weight;
    const EyeRay ray{end.point.origin_towards(*direction), *direction, end.ray.throughput * weight,
                     end.ray.pixel, end.ray.radiance_factor};
    const LampTechnique other{setup.lobes->lamps, density};
    const LookSamples looks(sample.of_pixel, sample.index * looks_at_hits, surface);
    const RandomStream random(setup.parameters->seed, sample.path,
                              first_stream + static_cast<std::uint32_t>(depth));
    const auto next = follow_eye_ray(setup, ray, random, record, &other, &looks);
    if (!next) return;
    end = *next;
  }
}

}  // namespace photile::trace
