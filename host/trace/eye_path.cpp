#include "trace/eye_path.hpp"

#include <optional>

#include "trace/direct_light.hpp"
#include "trace/holes.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/sobol.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

void add_direct_light(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                      bool lobe_only, const LookSamples& samples, EyeRecord& record) {
  thread_local std::vector<ReceivedLight> found;
  found.clear();
  find_direct_light(setup.direct->rays, setup.direct->lamps, point, ray.direction, lobe_only,
                    setup.direct->count, samples, found);
  const float sample_weight = 1.0f / static_cast<float>(setup.parameters->samples_per_pixel);
  for (const ReceivedLight& light : found) {
    record.direct.push_back({ray.pixel, light.layer, ray.radiance_weight() * light.radiance,
                             sample_weight * static_cast<float>(luminance(light.irradiance))});
  }
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

void follow_eye_ray(const EyeSetup& setup, EyeRay ray, const RandomStream& random,
                    EyeRecord& record, const LampTechnique* other, const LookSamples* looks) {
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
      if (!sees_lamps) return;
      for (const DistantLight& light : *setup.distant) {
        const glm::vec3 radiance = light.radiance(ray.direction);
        if (radiance == glm::vec3(0.0f)) continue;
        const float weight =
            other ? weight_against(other->lamps.density(light, ray.direction)) : 1.0f;
        record.emission.push_back(
            {ray.pixel, light.light(), weight * ray.radiance_weight() * radiance});
      }
      return;
    }
    const SurfacePoint& point = *met;
    if (emits(scene, point) && sees_lamps) {
      const std::uint32_t light = scene.triangle_light[point.where.triangle];
      const float weight = other ? weight_against(other->lamps.density(start, point)) : 1.0f;
      record.emission.push_back({ray.pixel, light,
                                 weight * ray.radiance_weight() * (*setup.emitted_radiance)[light] *
                                     emission_texel(scene, point)});
    }
    if (material_of(scene, point).interaction == Interaction::opaque) {
      if (seen_directly && !material_of(scene, point).glossy()) return;
      append_hit(*setup.rays, point, ray, record);
      if (seen_directly) record.hits.back().diffuse_albedo = glm::vec3(0.0f);
      if (setup.direct) add_direct_light(setup, point, ray, seen_directly, *looks, record);
      return;
    }
    if (depth >= setup.parameters->max_specular_depth) return;
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

void trace_eye_path(const EyeSetup& setup, int x, int y, int sample, EyeRecord& record) {
  const PrimaryHitParameters& film = *setup.parameters;
  const auto pixel = static_cast<std::uint32_t>(y) * film.width + x;
  const RandomStream random(film.seed, std::uint64_t{pixel} * film.samples_per_pixel + sample, 0);
  // All samples of a pixel share their sequences.
  const RandomStream of_pixel(film.seed, pixel, 0);
  const auto index = static_cast<std::uint32_t>(sample);
  const glm::dvec2 offset = sobol_point(index, of_pixel.block(Purpose::film_position, 0));
  const EyeRay ray{setup.eye, glm::vec3((*setup.film)(x + offset.x, y + offset.y)),
                   glm::vec3(1.0f / static_cast<float>(film.samples_per_pixel)), pixel};
  std::optional<LookSamples> looks;
  if (setup.direct) {
    looks.emplace(of_pixel, index * static_cast<std::uint32_t>(setup.direct->count));
  }
  follow_eye_ray(setup, ray, random, record, nullptr, looks ? &*looks : nullptr);
}

}  // namespace photile::trace
