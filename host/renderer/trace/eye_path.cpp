#include "trace/eye_path.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "photile/defaults.hpp"
#include "trace/direct_light.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

namespace {

void add_direct_light(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                      ReflectedPart part, const LightSampleNumbers& samples, EyeRecord& record) {
  thread_local std::vector<ReceivedLight> found;
  found.clear();
  find_direct_light(setup.direct->rays, setup.direct->light_sampler, point, ray.direction, part,
                    setup.direct->count, samples, found);
  const float weight = ray.share() / static_cast<float>(setup.parameters->samples_per_pixel);
  for (const ReceivedLight& light : found) {
    record.direct.push_back({ray.pixel, light.layer, ray.radiance_weight() * light.radiance,
                             weight * static_cast<float>(luminance(light.irradiance))});
  }
}

/// The light of hot spots at the hit that was appended last, as it reflects there.
void add_hot_spots(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                   ReflectedPart part, EyeRecord& record) {
  const float weight = ray.share() / static_cast<float>(setup.parameters->samples_per_pixel);
  for_each_hot_light(
      *setup.rays, *setup.hot_spots, point,
      [&](const LightSample& light, const glm::vec3& arrives) {
        OpaqueBsdf bsdf(*setup.rays->scene, point, ray.direction);
        bsdf.shade_smoothly(*setup.rays->scene, point);
        if (part == ReflectedPart::but_the_base) bsdf.drop_diffuse();
        if (part == ReflectedPart::but_the_lobe) bsdf.drop_lobe();
        const float cosine = glm::dot(light.direction, point.normal);
        record.direct.push_back({ray.pixel, light.layer,
                                 ray.radiance_weight() * bsdf.reflected(light.direction) * arrives,
                                 weight * cosine * static_cast<float>(luminance(arrives))});
      });
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

void append_lobe(const EyeSetup& setup, const EyeEnd& end, const OpaqueBsdf& bsdf,
                 EyeRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const float weight = end.ray.share() / static_cast<float>(setup.parameters->samples_per_pixel);
  const PixelLobes seen{end.ray.pixel,
                        weight,
                        weight * end.point.position,
                        weight * shading_normals(scene, end.point, end.ray.direction).seen,
                        weight * bsdf.lobe_reflectance(),
                        weight * reflectance(scene, end.point).alpha};
  if (record.lobes.empty() || record.lobes.back().pixel != seen.pixel) {
    record.lobes.push_back(seen);
  } else {
    record.lobes.back().add(seen);
  }
}

/// The next surface that a ray meets. A surface that is partly there lets the ray on by chance, or
/// as a part of it that is appended to `split`, where that is given and counts enough.
std::optional<SurfacePoint> meet(const RayScene::Impl& rays, EyeRay& ray,
                                 const RandomStream& random, std::vector<EyeRay>* split) {
  if (!split) {
    return next_surface(rays, ray.origin, ray.direction, random, Purpose::eye_cutouts, ray.cutouts);
  }
  const Scene& scene = *rays.scene;
  while (const auto hit = rays.intersect(ray.origin, ray.direction)) {
    const SurfacePoint point = surface_hit(scene, *hit, ray.direction);
    const float there = material_of(scene, point).has_cutouts() ? opacity(scene, point) : 1.0f;
    const glm::vec3 beyond = point.origin_towards(ray.direction);
    if (ray.fraction * std::min(there, 1.0f - there) >= defaults::least_glass_fraction) {
      EyeRay passing = ray;
      passing.origin = beyond;
      passing.throughput *= 1.0f - there;
      passing.fraction *= 1.0f - there;
      split->push_back(passing);
      ray.throughput *= there;
      ray.fraction *= there;
      return point;
    }
    if (!passes_cutout(scene, point, random, Purpose::eye_cutouts, ray.cutouts)) return point;
    ray.origin = beyond;
  }
  return std::nullopt;
}

/// Whether two rays met the same surface, which has about the same colour at both hits.
bool is_one_surface(const Scene& scene, const EyeRecord& a, const EyeRecord& b) {
  if (a.hits.empty() || b.hits.empty()) return a.hits.empty() && b.hits.empty();
  const EyeHit &one = a.hits.front(), &other = b.hits.front();
  const std::uint32_t triangle = triangle_of(one.oriented_face),
                      beside = triangle_of(other.oriented_face);
  if (scene.triangle_material[triangle] != scene.triangle_material[beside]) return false;
  const glm::vec3 darker = glm::min(one.diffuse_albedo, other.diffuse_albedo),
                  brighter = glm::max(one.diffuse_albedo, other.diffuse_albedo);
  if (largest(brighter - darker) > defaults::edge_contrast * largest(brighter)) return false;
  if (triangle == beside) return true;
  const glm::vec3 normal(face_normal(scene, one.oriented_face)),
      apart = other.position - one.position;
  return glm::dot(normal, glm::vec3(face_normal(scene, other.oriented_face))) >
             defaults::edge_cosine &&
         std::abs(glm::dot(normal, apart)) <= defaults::edge_slope * glm::length(apart);
}

/// Makes `ray` the one that leaves a mirror or glass with this fraction of its light.
void go_on(const Scene& scene, const SurfacePoint& point, const Scattered& scattered,
           float fraction, EyeRay& ray) {
  ray.throughput *= fraction * scattered.weight;
  ray.fraction *= fraction;
  ray.radiance_factor *= scattered.radiance_factor;
  ray.unscattered =
      ray.unscattered && scattered.direction == ray.direction && material_of(scene, point).thin;
  ray.direction = scattered.direction;
  ray.origin = point.origin_towards(ray.direction);
  ++ray.depth;
}

}  // namespace

void append_hit(const RayScene::Impl& rays, const SurfacePoint& point, const EyeRay& ray,
                EyeRecord& record) {
  const scene::Reflectance surface = reflectance(*rays.scene, point);
  record.hits.push_back({point.position, face_of_photons(*rays.scene, point), ray.pixel,
                         ray.radiance_weight(), surface.albedo, ray.share()});
  if (!rays.needs.glossy) return;
  const ShadingNormals normals = shading_normals(*rays.scene, point, ray.direction);
  record.glossy.push_back(
      {-ray.direction, {surface.f0, surface.alpha, normals.seen, surface.f90, normals.smooth}});
}

void append_eye_hit(const EyeSetup& setup, const SurfacePoint& point, const EyeRay& ray,
                    EyeRecord& record) {
  append_hit(*setup.rays, point, ray, record);
  if (setup.hot_spots) add_hot_spots(setup, point, ray, ReflectedPart::all, record);
}

std::optional<EyeEnd> follow_eye_ray(const EyeSetup& setup, EyeRay ray, const RandomStream& random,
                                     EyeRecord& record, const LightTechnique* other,
                                     const LightSampleNumbers* light_samples,
                                     std::vector<EyeRay>* split) {
  const Scene& scene = *setup.rays->scene;
  const glm::vec3 start = ray.origin.position;
  // Lights seen in mirrors or through refracting glass are found by following alone.
  const bool sees_near_lights = other == nullptr || !other->distant_only;
  const auto weight_against = [&](float found) {
    return ray.unscattered ? power_heuristic(other->density, found) : 1.0f;
  };
  for (;;) {
    const bool seen_directly = setup.reflections_only && ray.unscattered;
    const bool sees_lights = setup.emitted_radiance != nullptr && !seen_directly &&
                             (ray.unscattered || other == nullptr || !other->only);
    ++record.rays;
    const auto met = meet(*setup.rays, ray, random, split);
    if (!met) {
      if (!sees_lights) return std::nullopt;
      setup.distant->for_each_shining(
          ray.direction, [&](const DistantLight& light, const glm::vec3& radiance) {
            const float weight = other ? weight_against(other->light_sampler.density(
                                             light, start, ray.direction, other->probabilities))
                                       : 1.0f;
            record.emission.push_back(
                {ray.pixel, light.light(), weight * ray.radiance_weight() * radiance});
          });
      return std::nullopt;
    }
    const SurfacePoint& point = *met;
    if (emits(scene, point) && sees_lights && (sees_near_lights || !ray.unscattered)) {
      const std::uint32_t light = scene.triangle_light[point.where.triangle];
      const float weight =
          other ? weight_against(other->light_sampler.density(start, point, other->probabilities))
                : 1.0f;
      record.emission.push_back({ray.pixel, light,
                                 weight * ray.radiance_weight() * (*setup.emitted_radiance)[light] *
                                     emission_towards(scene, point, -ray.direction)});
    }
    if (material_of(scene, point).interaction == Interaction::opaque) {
      if (seen_directly && !material_of(scene, point).glossy()) return std::nullopt;
      if (ray.beside && ray.unscattered) {
        ray.throughput *=
            static_cast<float>(ray.beside->aim.weight_beside(ray.beside->density, point));
      }
      append_hit(*setup.rays, point, ray, record);
      if (seen_directly) record.hits.back().diffuse_albedo = glm::vec3(0.0f);
      glm::vec3 base;
      const bool lobe_left = leaves_lobe(setup, point, ray, base);
      if (lobe_left) drop_lobe(base, record);
      const ReflectedPart part = seen_directly ? ReflectedPart::but_the_base
                                 : lobe_left   ? ReflectedPart::but_the_lobe
                                               : ReflectedPart::all;
      if (setup.direct) add_direct_light(setup, point, ray, part, *light_samples, record);
      if (setup.hot_spots) add_hot_spots(setup, point, ray, part, record);
      if (!lobe_left) return std::nullopt;
      return EyeEnd{point, ray};
    }
    if (ray.depth >= setup.parameters->max_specular_depth) return std::nullopt;
    if (split) {
      if (const auto parts = both_parts(scene, point, ray.direction)) {
        const float lesser = std::min(parts->reflectance, 1.0f - parts->reflectance);
        if (ray.fraction * lesser >= defaults::least_glass_fraction) {
          EyeRay reflected = ray;
          go_on(scene, point, parts->reflected, parts->reflectance, reflected);
          go_on(scene, point, parts->transmitted, 1.0f - parts->reflectance, ray);
          if (parts->reflectance > 0.5f) std::swap(ray, reflected);
          split->push_back(reflected);
          continue;
        }
      }
    }
    const RandomBlock numbers = random.block(Purpose::eye_scattering, ray.depth);
    go_on(scene, point, scatter_specular(scene, point, ray.direction, numbers.uniform(choice_word)),
          1.0f, ray);
  }
}

namespace {

/// A sample of a pixel of the film, and its ray from the eye.
struct FilmSample {
  std::uint32_t pixel, index;
  std::uint64_t path;
  RandomStream random, of_pixel;  ///< all samples of a pixel share the sequences of the latter
  RandomBlock scramble;
  EyeRay ray;  ///< its direction is 0 beyond the circle of a fisheye

  FilmSample(const EyeSetup& setup, int x, int y, int sample, int times, std::uint32_t sequence = 0)
      : pixel(static_cast<std::uint32_t>(y) * setup.parameters->width + x),
        index(static_cast<std::uint32_t>(sample)),
        path(std::uint64_t{pixel} * setup.parameters->samples_per_pixel *
                 setup.parameters->times_at_edges +
             index),
        random(setup.parameters->seed, path, sequence),
        of_pixel(setup.parameters->seed, pixel, 0),
        scramble(of_pixel.block(Purpose::film_position, sequence)) {
    const PrimaryHitParameters& film = *setup.parameters;
    const glm::dvec2 at = glm::dvec2(x, y) + sobol_point(index, scramble);
    // Samples beyond the usual ones go to the same runs, so that each run has its part of them.
    const int run = sample % film.samples_per_pixel * film.runs / film.samples_per_pixel;
    ray.origin = setup.eye + glm::vec3(setup.film->offset(at.x, at.y));
    ray.direction = glm::vec3((*setup.film)(at.x, at.y));
    ray.sample_share = 1.0f / static_cast<float>(times);
    ray.throughput = glm::vec3(ray.sample_share / static_cast<float>(film.samples_per_pixel));
    ray.pixel = pixel * static_cast<std::uint32_t>(film.runs) + static_cast<std::uint32_t>(run);
  }
};

}  // namespace

void trace_eye_path(const EyeSetup& setup, int x, int y, int sample, int times, EyeRecord& record,
                    EyeRecord& reflected) {
  const PrimaryHitParameters& film = *setup.parameters;
  auto [pixel, index, path, random, of_pixel, scramble, ray] =
      FilmSample(setup, x, y, sample, times);
  if (ray.direction == glm::vec3(0.0f)) return;
  std::optional<LightSampleNumbers> light_samples;
  if (setup.direct) {
    light_samples.emplace(of_pixel, index * static_cast<std::uint32_t>(setup.direct->count));
  }
  thread_local std::vector<EyeRay> waiting;  // empty but within this function
  std::vector<EyeRay>* const split = film.split_at_glass ? &waiting : nullptr;
  for (;;) {
    auto end = follow_eye_ray(setup, ray, random, record, nullptr,
                              light_samples ? &*light_samples : nullptr, split);
    if (end) {
      const OpaqueBsdf bsdf(*setup.rays->scene, end->point, end->ray.direction);
      // Whole rays, in turn with the other samples where each has a part of one.
      const double rays = bsdf.lobe_rays(), start = scramble.uniform(3);
      const auto first_ray = static_cast<std::uint32_t>(index * rays + start);
      const auto end_ray = static_cast<std::uint32_t>((index + 1) * rays + start);
      append_lobe(setup, *end, bsdf, reflected);
      end->ray.throughput /= static_cast<float>(rays);
      for (std::uint32_t i = first_ray; i < end_ray; ++i) {
        follow_lobes(setup, *end, {of_pixel, i, path, i - first_ray}, reflected);
      }
    }
    if (!split || split->empty()) return;
    ray = split->back();
    split->pop_back();
  }
}

bool shows_edge(const EyeSetup& setup, int x, int y, EyeRecord& record) {
  EyeSetup surfaces_alone = setup;
  surfaces_alone.emitted_radiance = nullptr;
  surfaces_alone.direct = nullptr;
  surfaces_alone.lobes = nullptr;
  surfaces_alone.hot_spots = nullptr;
  const Scene& scene = *setup.rays->scene;
  EyeRecord first, other;
  std::vector<EyeRay> lesser_parts;  // of rays that glass splits: left out
  for (int sample = 0; sample < defaults::edge_probes; ++sample) {
    // From another sequence than the film: else samples that find a small lamp would be thinned.
    const FilmSample probe(setup, x, y, sample, 1, 1);
    EyeRecord& own = sample == 0 ? first : other;
    own.hits.clear();
    own.glossy.clear();
    if (probe.ray.direction != glm::vec3(0.0f)) {
      lesser_parts.clear();
      follow_eye_ray(surfaces_alone, probe.ray, probe.random, own, nullptr, nullptr, &lesser_parts);
    }
    record.rays += std::exchange(own.rays, 0);
    if (sample > 0 && !is_one_surface(scene, first, other)) return true;
  }
  return false;
}

namespace {

/// The deviation of the base that a light sample stands for is bounded by that of light of its
/// radiance from this many hemispheres. Beside a lamp a single sample would otherwise remove all
/// light of its pixel, for a difference of a few percent.
constexpr float most_received = 8;

/// A light as the lobe reflects it; also by how much the base reflects more or less of it than of
/// light from all sides, because hits hold no more of the base.
void sample_light(const EyeSetup& setup, const EyeEnd& end, const OpaqueBsdf& whole,
                  const OpaqueBsdf& lobe, const LightSampleNumbers::Sample& light_sample,
                  EyeRecord& record) {
  const auto light = setup.lobes->light_sampler.sample(end.point.position, light_sample.choice,
                                                       light_sample.position);
  if (!light) return;
  glm::vec3 reflected =
      lobe.reflected(light->direction) * light->weight_beside(lobe.density(light->direction));
  // Light samples that give the base all of its direct light know where it comes from.
  if (!setup.direct)
    reflected += light->weight_below(most_received) * whole.base_deviation(light->direction);
  glm::vec3 radiance = reflected * light->received;
  if (radiance == glm::vec3(0.0f)) return;
  radiance *=
      transmittance(setup.lobes->rays, end.point.origin_towards(light->direction), light->target);
  if (radiance == glm::vec3(0.0f)) return;
  record.direct.push_back({end.ray.pixel, light->layer, end.ray.radiance_weight() * radiance});
}

}  // namespace

void follow_lobes(const EyeSetup& setup, EyeEnd end, const PixelSample& sample, EyeRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const std::uint32_t first_stream =
      sample.ray * (static_cast<std::uint32_t>(setup.parameters->max_specular_depth) + 1);
  const auto light_samples_per_hit =
      static_cast<std::uint32_t>(setup.direct ? setup.direct->count : 1);
  glm::vec3 left(1.0f);  // of the light, since the first lobe
  for (int depth = 1; depth <= setup.parameters->max_specular_depth; ++depth) {
    const auto surface = static_cast<std::uint32_t>(2 * depth);
    OpaqueBsdf whole(scene, end.point, end.ray.direction);
    whole.shade_smoothly(scene, end.point);
    OpaqueBsdf lobe = whole;
    lobe.keep_lobe();
    const LightSampleNumbers::Sample light_sample =
        LightSampleNumbers(sample.of_pixel, sample.index, surface - 1).sample(0);
    sample_light(setup, end, whole, lobe, light_sample, record);
    const auto direction = lobe.sample(light_sample.direction);
    if (!direction) return;
    const float density = lobe.density(*direction);
    if (!(density > 0.0f)) return;
    glm::vec3 weight = lobe.reflected(*direction) / density;
    const float survival = std::min(1.0f, largest(left * weight) / defaults::least_lobe_weight);
    // The word has no other use.
    if (!(light_sample.direction.uniform(choice_word) < survival)) return;
    weight /= survival;
    left *= weight;
    EyeRay ray{end.point.origin_towards(*direction), *direction, end.ray.throughput * weight,
               end.ray.pixel, end.ray.radiance_factor};
    ray.sample_share = end.ray.sample_share;
    const LightTechnique other{setup.lobes->light_sampler, density};
    const LightSampleNumbers light_samples(sample.of_pixel, sample.index * light_samples_per_hit,
                                           surface);
    const RandomStream random(setup.parameters->seed, sample.path,
                              first_stream + static_cast<std::uint32_t>(depth));
    const auto next = follow_eye_ray(setup, ray, random, record, &other, &light_samples);
    if (!next) return;
    end = *next;
  }
}

}  // namespace photile::trace
