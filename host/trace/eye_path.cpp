#include "trace/eye_path.hpp"

#include <optional>

#include "trace/direct_light.hpp"
#include "trace/holes.hpp"
#include "trace/lobe_path.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/sobol.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

void add_direct_light(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                      ReflectedPart part, const LookSamples& samples, EyeRecord& record) {
  thread_local std::vector<ReceivedLight> found;
  found.clear();
  find_direct_light(setup.direct->rays, setup.direct->lamps, point, ray.direction, part,
                    setup.direct->count, samples, found);
  const float sample_weight = 1.0f / static_cast<float>(setup.parameters->samples_per_pixel);
  for (const ReceivedLight& light : found) {
    record.direct.push_back({ray.pixel, light.layer, ray.radiance_weight() * light.radiance,
                             sample_weight * static_cast<float>(luminance(light.irradiance))});
  }
}

/// Whether rays are to follow the lobe of a surface; `base` is then what else it reflects.
bool leaves_lobe(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                 glm::vec3& base) {
  if (!setup.lobes || !material_of(*setup.rays->scene, point).glossy()) return false;
  const OpaqueBsdf bsdf(*setup.rays->scene, point, ray.direction);
  if (!bsdf.lobe_suits_rays()) return false;
  base = bsdf.base_reflectance();
  return true;
}

/// Makes the hit that was appended last one whose surface has a base alone, as far as light from
/// all sides tells it.
void drop_lobe(const glm::vec3& base, EyeRecord& record) {
  record.hits.back().diffuse_albedo = base;
  HitLobe& lobe = record.glossy.back().lobe;
  lobe.specular = glm::vec3(0.0f);
  lobe.f90 = 0.0f;
  lobe.roughness = 1.0f;
}

}  // namespace

void append_hit(const RayScene::Impl& rays, const SurfacePoint& point, const EyeRay& ray,
                EyeRecord& record) {
  const scene_io::Reflectance surface = reflectance(*rays.scene, point);
  record.hits.push_back(
      {point.position, point.sided_triangle(), ray.pixel, ray.radiance_weight(), surface.albedo});
  if (!rays.needs.glossy) return;
  const ShadingNormals normals = shading_normals(*rays.scene, point, ray.direction);
  record.glossy.push_back(
      {-ray.direction, {surface.f0, surface.alpha, normals.seen, surface.f90, normals.smooth}});
}

std::optional<EyeEnd> follow_eye_ray(const EyeSetup& setup, EyeRay ray, const RandomStream& random,
                                     EyeRecord& record, const LampTechnique* other,
                                     const LookSamples* looks) {
  const Scene& scene = *setup.rays->scene;
  const glm::vec3 start = ray.origin;
  std::uint32_t holes = 0;
  bool straight = true;  // but for panes of thin glass, which looking at lamps sees through
  // Lamps seen in mirrors or through refracting glass are found by following alone.
  const auto weight_against = [&](float found) {
    return straight ? power_heuristic(other->density, found) : 1.0f;
  };
  for (int depth = 0;; ++depth) {
    const bool seen_directly = setup.reflections_only && straight;
    const bool sees_lamps = setup.emitted_radiance != nullptr && !seen_directly &&
                            (straight || other == nullptr || !other->only);
    ++record.rays;
    const auto met =
        next_surface(*setup.rays, ray.origin, ray.direction, random, Purpose::eye_holes, holes);
    if (!met) {
      if (!sees_lamps) return std::nullopt;
      for (const DistantLight& light : *setup.distant) {
        const glm::vec3 radiance = light.radiance(ray.direction);
        if (radiance == glm::vec3(0.0f)) continue;
        const float weight =
            other ? weight_against(other->lamps.density(light, ray.direction, other->chances))
                  : 1.0f;
        record.emission.push_back(
            {ray.pixel, light.light(), weight * ray.radiance_weight() * radiance});
      }
      return std::nullopt;
    }
    const SurfacePoint& point = *met;
    if (emits(scene, point) && sees_lamps) {
      const std::uint32_t light = scene.triangle_light[point.where.triangle];
      const float weight =
          other ? weight_against(other->lamps.density(start, point, other->chances)) : 1.0f;
      record.emission.push_back({ray.pixel, light,
                                 weight * ray.radiance_weight() * (*setup.emitted_radiance)[light] *
                                     emission_texel(scene, point)});
    }
    if (material_of(scene, point).interaction == Interaction::opaque) {
      if (seen_directly && !material_of(scene, point).glossy()) return std::nullopt;
      append_hit(*setup.rays, point, ray, record);
      if (seen_directly) record.hits.back().diffuse_albedo = glm::vec3(0.0f);
      glm::vec3 base;
      const bool lobe_left = leaves_lobe(setup, point, ray, base);
      if (lobe_left) drop_lobe(base, record);
      if (setup.direct) {
        const ReflectedPart part = seen_directly ? ReflectedPart::but_the_base
                                   : lobe_left   ? ReflectedPart::but_the_lobe
                                                 : ReflectedPart::all;
        add_direct_light(setup, point, ray, part, *looks, record);
      }
      if (!lobe_left) return std::nullopt;
      return EyeEnd{point, ray};
    }
    if (depth >= setup.parameters->max_specular_depth) return std::nullopt;
    const RandomBlock numbers = random.block(Purpose::eye_scattering, depth);
    const Scattered scattered =
        scatter_specular(scene, point, ray.direction, numbers.uniform(choice_word));
    ray.throughput *= scattered.weight;
    ray.radiance_factor *= scattered.radiance_factor;
    straight = straight && scattered.direction == ray.direction && material_of(scene, point).thin;
    ray.direction = scattered.direction;
    ray.origin = point.origin_towards(ray.direction);
  }
}

void trace_eye_path(const EyeSetup& setup, int x, int y, int sample, EyeRecord& record,
                    EyeRecord& reflected) {
  const PrimaryHitParameters& film = *setup.parameters;
  const auto pixel = static_cast<std::uint32_t>(y) * film.width + x;
  const std::uint64_t path = std::uint64_t{pixel} * film.samples_per_pixel + sample;
  const RandomStream random(film.seed, path, 0);
  // All samples of a pixel share their sequences.
  const RandomStream of_pixel(film.seed, pixel, 0);
  const auto index = static_cast<std::uint32_t>(sample);
  const glm::dvec2 offset = sobol_point(index, of_pixel.block(Purpose::film_position, 0));
  const auto place = static_cast<std::uint32_t>(sample * film.runs / film.samples_per_pixel) +
                     pixel * static_cast<std::uint32_t>(film.runs);
  const EyeRay ray{setup.eye, glm::vec3((*setup.film)(x + offset.x, y + offset.y)),
                   glm::vec3(1.0f / static_cast<float>(film.samples_per_pixel)), place};
  std::optional<LookSamples> looks;
  if (setup.direct) {
    looks.emplace(of_pixel, index * static_cast<std::uint32_t>(setup.direct->count));
  }
  auto end = follow_eye_ray(setup, ray, random, record, nullptr, looks ? &*looks : nullptr);
  if (!end) return;
  const OpaqueBsdf bsdf(*setup.rays->scene, end->point, end->ray.direction);
  const auto rays = static_cast<std::uint32_t>(bsdf.lobe_rays());
  end->ray.throughput /= static_cast<float>(rays);
  for (std::uint32_t i = 0; i < rays; ++i) {
    follow_lobes(setup, *end, {of_pixel, index * rays + i, path, i}, reflected);
  }
}

}  // namespace photile::trace
