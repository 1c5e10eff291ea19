#include "trace/hemisphere_rays.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>

#include "common/touched_memory.hpp"
#include "photile/defaults.hpp"
#include "trace/direct_light.hpp"
#include "trace/hot_spots.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/shading_point.hpp"

namespace photile::trace {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 16;

/// Of ray ends on coats, those with a light sample: what it adds is a part of their light.
constexpr float coats_with_light_samples = 0.25f;
/// What bounds its noise: the least alpha of a lobe, and the most hemispheres of a lamp's radiance.
constexpr float coat_alpha = 0.1f, most_received_by_coats = 8;

struct TaskHits {
  EyeRecord ray_hits;
  std::vector<std::size_t> count, emission_count, direct_count;  ///< of each point
  std::vector<float> inverse_distances;                          ///< of each point
  std::vector<glm::vec3> direction;                              ///< of each ray
};

/// What the rays of a run have in common.
struct RunSetup {
  const RayScene& rays;
  const HemisphereParameters& parameters;
  EyeSetup first;  ///< of rays that leave a point
  EyeSetup later;  ///< of those that go on from near surface
  /// Of all but the directions in which rays leave points.
  std::uint64_t seed_of_rays;
};

/// A direction in which a ray goes on from near surface.
struct Onward {
  glm::vec3 direction;
  glm::vec3 weight;  ///< of the light from there
  float density;     ///< of the direction, per steradian
};

/// Light that a lobe reflects: of one light sample, which is added to the ray hits, and from a
/// direction of the lobe; none where that would enter the surface.
///   hit   where the lobe is, with the throughput of the ray
std::optional<Onward> reflect_by_lobe(const RunSetup& run, const OpaqueBsdf& bsdf,
                                      const SurfacePoint& point, const RandomStream& random,
                                      const EyeHit& hit, EyeRecord& ray_hits) {
  const auto light =
      run.parameters.light_sampler->sample(point.position, random.block(Purpose::direct_light, 0),
                                           random.block(Purpose::direct_light, 1));
  if (light && !hot_spots_of(run.rays).holds(light->light, point.position)) {
    const glm::vec3 radiance = hit.throughput * bsdf.reflected(light->direction) * light->received *
                               light->weight_beside(bsdf.density(light->direction));
    if (radiance != glm::vec3(0.0f)) {
      const RayOrigin origin = point.origin_towards(light->direction);
      ray_hits.direct.push_back(
          {hit.pixel, light->layer, radiance * transmittance(run.rays, origin, light->target)});
    }
  }
  const auto direction = bsdf.sample(random.block(Purpose::hemisphere_direction, 1));
  if (!direction) return std::nullopt;
  const float density = bsdf.density(*direction);
  if (!(density > 0.0f)) return std::nullopt;
  return Onward{*direction, bsdf.reflected(*direction) / density, density};
}

/// Replaces the last ray hit by light that reaches it, as long as it is surface near the point, or
/// a slat. A photon estimate there would show its blur: on a narrow frame it would count the
/// photons of faces that lie at angles to the hit's, and of a slat its bright edge, which is not
/// seen.
///   from     the point
///   before   hits of the rays before
///   stream   of the ray; those of later ones are `streams` apart
///   light_samples   those from near surface are added to these; their tag is the pixel
void go_on_from_near(const RunSetup& run, const SurfacePoint& from, std::uint64_t number,
                     std::size_t before, std::uint32_t stream, std::uint32_t streams,
                     ShadowRays& light_samples, EyeRecord& ray_hits) {
  const Scene& scene = run.rays.scene();
  const LightSampler& light_sampler = *run.parameters.light_sampler;
  const auto remove_last = [&] {
    ray_hits.hits.pop_back();
    if (!ray_hits.glossy.empty()) ray_hits.glossy.pop_back();
  };
  for (int bounce = 1; ray_hits.hits.size() > before; ++bounce) {
    EyeHit hit = ray_hits.hits.back();
    const std::span<const std::uint8_t> slats = run.parameters.slats;
    if (glm::distance(from.position, hit.position) >= run.parameters.near &&
        (slats.empty() || slats[hit.oriented_face] == 0)) {
      return;
    }
    const HitReflection reflection = reflection_of(ray_hits, ray_hits.hits.size() - 1);
    if (bounce > defaults::most_near_surfaces) {
      // Inside a metal solid, as at the rim of a board in its frame, hardly any light is left, but
      // the few photons that passed through a seam would have a large weight.
      if (reflection.strong_lobe) remove_last();
      return;
    }
    const SurfacePoint point = surface_point(scene, hit.oriented_face, hit.position);
    std::optional<OpaqueBsdf> bsdf;
    if (reflection.strong_lobe) bsdf.emplace(scene, point, -ray_hits.glossy.back().outgoing);
    remove_last();
    const RandomStream random(run.seed_of_rays, number,
                              stream + static_cast<std::uint32_t>(bounce) * streams);
    const RandomBlock numbers = random.block(Purpose::hemisphere_direction, 0);
    const float survival =
        std::min(1.0f, defaults::survival_of_reflectance * largest(reflection.reflectance));
    if (!(numbers.uniform(2) < survival)) return;
    hit.throughput /= survival;
    for_each_hot_light(
        impl_of(run.rays), light_sampler, point,
        [&](const LightSample& light, const glm::vec3& arrives) {
          const glm::vec3 reflected = bsdf ? bsdf->reflected(light.direction)
                                           : glm::one_over_pi<float>() * reflection.reflectance *
                                                 glm::dot(light.direction, point.normal);
          ray_hits.direct.push_back({hit.pixel, light.layer, hit.throughput * reflected * arrives});
        });
    std::optional<Onward> on;
    if (bsdf) {
      on = reflect_by_lobe(run, *bsdf, point, random, hit, ray_hits);
      if (!on) return;
    } else {
      const auto light =
          light_sampler.sample(point.position, random.block(Purpose::direct_light, 0),
                               random.block(Purpose::direct_light, 1));
      if (light && !hot_spots_of(run.rays).holds(light->light, point.position)) {
        light_samples.add(point, light,
                          glm::one_over_pi<float>() * hit.throughput * reflection.reflectance, 1.0f,
                          hit.pixel);
      }
      const glm::vec3 direction =
          Frame(point.normal)
              .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
      on = {direction, reflection.reflectance,
            std::max(0.0f, glm::dot(direction, point.normal)) * glm::one_over_pi<float>()};
    }
    const LightTechnique light_sampling{light_sampler, on->density, true};
    const std::size_t seen_before = ray_hits.emission.size();
    follow_eye_ray(run.later,
                   {point.origin_towards(on->direction), on->direction, hit.throughput * on->weight,
                    hit.pixel},
                   random, ray_hits, &light_sampling);
    for (std::size_t i = seen_before; i < ray_hits.emission.size(); ++i) {
      const VisibleEmission& seen = ray_hits.emission[i];
      ray_hits.direct.push_back({seen.pixel, light_sampler.layer(seen.light), seen.radiance});
    }
    ray_hits.emission.resize(seen_before);
  }
}

/// A direction of a ray, and its density by the cosine over that of all that could be sampled.
struct Leaving {
  glm::vec3 direction;
  float weight;
};

/// Of directions by the cosine, or into the aim for a part of them.
///   aim   null: by the cosine alone
double density_of_leaving(const glm::vec3& direction, const Frame& frame, const Aim* aim) {
  const double by_cosine =
      std::max(0.0, static_cast<double>(glm::dot(direction, frame.n))) * glm::one_over_pi<double>();
  if (!aim) return by_cosine;
  constexpr double aimed = defaults::rays_to_bright;
  return aimed * aim->density(direction) + (1 - aimed) * by_cosine;
}

/// By the cosine, or into the aim for a part of the square.
///   aim   null: by the cosine alone
Leaving leaving(const Frame& frame, const Aim* aim, glm::dvec2 u) {
  const auto by_cosine = [&] {
    const glm::vec2 on_square(u);
    return frame.to_world(
        sample_cosine_hemisphere(std::min(on_square.x, 0x1.fffffep-1f), on_square.y));
  };
  if (!aim) return {by_cosine(), 1.0f};
  constexpr double aimed = defaults::rays_to_bright;
  Aim::Direction way{};
  if (u.x < aimed) {
    way = aim->sample({u.x / aimed, u.y});
  } else {
    u.x = (u.x - aimed) / (1 - aimed);
    way.direction = by_cosine();
    way.density = aim->density(way.direction);
  }
  const double cosine = std::max(0.0, static_cast<double>(glm::dot(way.direction, frame.n)));
  const double by_cosine_alone = cosine * glm::one_over_pi<double>();
  return {way.direction, static_cast<float>(by_cosine_alone /
                                            (aimed * way.density + (1 - aimed) * by_cosine_alone))};
}

/// Adds what estimates do not hold of direct light where rays end that did not go on: hits from
/// `before` on. That is the light of hot spots, which photons do not carry; and, by light samples
/// at some of the hits, how much more or less coats reflect of lamps than of light from all sides.
///   light_samples   those of coats are added to these; their tag is the pixel
void add_direct_light(const RunSetup& run, const RandomStream& random, std::size_t before,
                      ShadowRays& light_samples, EyeRecord& ray_hits) {
  const Scene& scene = run.rays.scene();
  const LightSampler& light_sampler = *run.parameters.light_sampler;
  const HotSpots& hot_spots = hot_spots_of(run.rays);
  for (std::size_t i = before; i < ray_hits.hits.size(); ++i) {
    const bool coated =
        !ray_hits.glossy.empty() && ray_hits.glossy[i].lobe.f90 > 0.0f &&
        random.block(Purpose::direct_light, 2).uniform(0) < coats_with_light_samples;
    if (!coated && hot_spots.empty()) continue;
    const EyeHit& hit = ray_hits.hits[i];
    const SurfacePoint point = surface_point(scene, hit.oriented_face, hit.position);
    OpaqueBsdf bsdf(scene, point,
                    ray_hits.glossy.empty() ? -point.normal : -ray_hits.glossy[i].outgoing);
    for_each_hot_light(
        impl_of(run.rays), light_sampler, point,
        [&](const LightSample& light, const glm::vec3& arrives) {
          ray_hits.direct.push_back(
              {hit.pixel, light.layer, hit.throughput * bsdf.reflected(light.direction) * arrives});
        });
    if (!coated) continue;
    const HitReflection reflection = reflection_of(ray_hits, i);
    const auto light = light_sampler.sample(point.position, random.block(Purpose::direct_light, 0),
                                            random.block(Purpose::direct_light, 1));
    if (reflection.strong_lobe || !light || hot_spots.holds(light->light, point.position)) continue;
    bsdf.widen_lobe(coat_alpha);
    const float cosine = glm::dot(light->direction, point.normal);
    const float weight = light->weight_below(most_received_by_coats) / coats_with_light_samples;
    const glm::vec3 more = bsdf.reflected(light->direction) / cosine -
                           glm::one_over_pi<float>() * reflection.reflectance;
    light_samples.add(point, light, weight * hit.throughput * more, 0.0f, hit.pixel);
  }
}

/// A target of a ray that is aimed at a hot spot, as seen from a point, with what its light counts;
/// nothing where something is in the way.
///   bright   where the other rays are aimed at, or null
struct Aimed {
  HotSpotAim::Target target;
  glm::vec3 weight;
};
std::optional<Aimed> to_hot_spot(const RunSetup& run, const SurfacePoint& point, const Frame& frame,
                                 const HotSpotAim& aim, const Aim* bright, const glm::dvec2& u) {
  const auto target = aim.sample(u);
  if (!target) return std::nullopt;
  const float cosine = glm::dot(target->direction, point.normal);
  if (!(cosine > 0.0f)) return std::nullopt;
  const glm::vec3 passes = transmittance(run.rays, point.origin_towards(target->direction),
                                         target->point.origin_towards(-target->direction));
  if (passes == glm::vec3(0.0f)) return std::nullopt;
  const double others = density_of_leaving(target->direction, frame, bright);
  const double by_cosine = double{cosine} * glm::one_over_pi<double>();
  return Aimed{*target,
               static_cast<float>(by_cosine / others * aim.weight(others, *target)) * passes};
}

/// All rays of a point. Returns the sum of their inverse distances to what they meet first.
///   run_point   its position in the run
float trace_point(const RunSetup& run, const SurfacePoint& point, std::uint64_t number,
                  std::uint32_t run_point, TaskHits& found) {
  EyeRecord& ray_hits = found.ray_hits;
  const HemisphereParameters& parameters = run.parameters;
  const auto batches = static_cast<std::uint32_t>(parameters.batches);
  const auto rays = static_cast<std::uint32_t>(parameters.rays);
  const RandomStream of_point(parameters.seed, number, 0);
  const Frame frame(point.normal);
  const glm::vec3 throughput(glm::pi<float>() / static_cast<float>(rays));
  thread_local SelectionProbabilities probabilities;
  thread_local ShadowRays light_samples;
  light_samples.clear();
  if (parameters.rays_per_light_sample > 0)
    parameters.light_sampler->weigh(point.position, point.normal, probabilities);
  std::optional<Aim> aim;
  if (parameters.bright && !parameters.bright->empty()) {
    aim.emplace(*parameters.bright, glm::dvec3(point.position), &point.normal);
    if (!aim->possible()) aim.reset();
  }
  const Aim* const bright = aim ? &*aim : nullptr;
  const HotSpotAim hot_spots(hot_spots_of(run.rays), point.position, &point.normal);
  const double to_hot_spots = hot_spots.fraction();
  float inverse_distances = 0;
  const auto end_ray = [&](std::size_t before, float weight, std::uint32_t stream) {
    if (ray_hits.hits.size() == before) return;
    inverse_distances +=
        weight / std::max(1e-6f, glm::distance(point.position, ray_hits.hits.back().position));
    if (parameters.near > 0) {
      go_on_from_near(run, point, number, before, stream, batches * rays, light_samples, ray_hits);
    }
    add_direct_light(run, RandomStream(run.seed_of_rays, number, stream), before, light_samples,
                     ray_hits);
  };
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    const RandomBlock scramble = of_point.block(Purpose::hemisphere_direction, batch);
    for (std::uint32_t i = 0; i < rays; ++i) {
      // A stream for each, apart from the point's own.
      const std::uint32_t stream = batch * rays + i + 1;
      const std::uint32_t ray = (run_point * batches + batch) * rays + i;
      const std::size_t before = ray_hits.hits.size();
      glm::dvec2 u = sobol_point(parameters.first_ray + i, scramble);
      if (u.x < to_hot_spots) {
        const auto aimed =
            to_hot_spot(run, point, frame, hot_spots, bright, {u.x / to_hot_spots, u.y});
        const glm::vec3 direction = aimed ? aimed->target.direction : point.normal;
        if (run.rays.needs().smooth_shading) found.direction.push_back(direction);
        if (!aimed) continue;
        append_hit(impl_of(run.rays), aimed->target.point,
                   {point.origin_towards(direction), direction, aimed->weight * throughput, ray},
                   ray_hits);
        end_ray(before, largest(aimed->weight), stream);
        continue;
      }
      u.x = (u.x - to_hot_spots) / (1 - to_hot_spots);
      auto [direction, weight] = leaving(frame, bright, u);
      if (run.rays.needs().smooth_shading) found.direction.push_back(direction);
      if (!(weight > 0)) continue;  // below the horizon
      weight /= static_cast<float>(1 - to_hot_spots);
      const RandomStream random(run.seed_of_rays, number, stream);
      // Light samples are weighed beside rays by the cosine alone.
      const float cosine = std::max(0.0f, glm::dot(direction, point.normal));
      const LightTechnique light_sampling{
          *parameters.light_sampler,
          parameters.rays_per_light_sample * cosine * glm::one_over_pi<float>(), true,
          probabilities};
      EyeRay leaves{point.origin_towards(direction), direction, weight * throughput, ray};
      const BesideHotSpots beside{
          hot_spots, to_hot_spots > 0 ? density_of_leaving(direction, frame, bright) : 0.0};
      if (to_hot_spots > 0) leaves.beside = &beside;
      follow_eye_ray(run.first, leaves, random, ray_hits, &light_sampling);
      end_ray(before, weight, stream);
    }
  }
  for (const ShadowRays::Found& light : light_samples.found(run.rays)) {
    ray_hits.direct.push_back({light.tag, light.layer, light.irradiance});
  }
  return inverse_distances;
}

HemisphereRays join(std::vector<TaskHits> tasks) {
  HemisphereRays all;
  const auto of_tasks = [&](auto TaskHits::*array) {
    return joined(
        tasks.size(), [&](std::size_t i) -> const auto& { return tasks[i].*array; });
  };
  const auto join_hits = [&](auto EyeRecord::*array) {
    all.ray_hits.*array = joined(
        tasks.size(), [&](std::size_t i) -> const auto& { return tasks[i].ray_hits.*array; });
  };
  const auto first_of = [&](std::vector<std::size_t> TaskHits::*counts) {
    std::vector<std::size_t> first = of_tasks(counts);
    first.push_back(0);
    std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
    return first;
  };
  tbb::parallel_invoke([&] { join_hits(&EyeRecord::hits); }, [&] { join_hits(&EyeRecord::glossy); },
                       [&] { join_hits(&EyeRecord::direct); },
                       [&] { join_hits(&EyeRecord::emission); },
                       [&] { all.direction = of_tasks(&TaskHits::direction); },
                       [&] { all.inverse_distances = of_tasks(&TaskHits::inverse_distances); });
  all.first = first_of(&TaskHits::count);
  all.first_emission = first_of(&TaskHits::emission_count);
  all.first_direct = first_of(&TaskHits::direct_count);
  for (const TaskHits& task : tasks) all.ray_hits.rays += task.ray_hits.rays;
  return all;
}

}  // namespace

HitReflection reflection_of(const EyeRecord& ray_hits, std::size_t hit) {
  const glm::vec3& albedo = ray_hits.hits[hit].diffuse_albedo;
  if (ray_hits.glossy.empty() || ray_hits.glossy[hit].lobe.f90 == 0.0f) return {albedo, false};
  const GlossyEyeHit& glossy = ray_hits.glossy[hit];
  const scene::Reflectance surface{albedo, glossy.lobe.specular, glossy.lobe.f90,
                                   glossy.lobe.roughness};
  const float cosine = std::max(glm::dot(glossy.lobe.normal, glossy.outgoing), 1e-6f);
  PhotileAlbedoFit fit;
  photile_albedo_fit(surface.alpha, &fit);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&fit, cosine, &f0_weight, &f90_weight);
  const glm::vec3 lobe = f0_weight * surface.f0 + f90_weight * surface.f90;
  return {lobe + diffuse_reflectance(diffuse_part(surface, cosine), surface.alpha),
          largest(lobe) > defaults::strong_lobe};
}

HemisphereRays trace_hemispheres(const RayScene& rays, const PrimaryHits& points, std::size_t first,
                                 std::size_t count, std::span<const std::uint64_t> number,
                                 const HemisphereParameters& parameters) {
  PrimaryHitParameters specular;
  specular.max_specular_depth = parameters.max_specular_depth;
  const EyeSetup later{.rays = &impl_of(rays),
                       .parameters = &specular,
                       .emitted_radiance = parameters.emitted_radiance,
                       .distant = &parameters.light_sampler->distant()};
  EyeSetup leaving = later;
  if (!(parameters.rays_per_light_sample > 0)) leaving.emitted_radiance = nullptr;
  const RunSetup run{rays, parameters, leaving, later,
                     parameters.first_ray == 0
                         ? parameters.seed
                         : seed_of_repeat(parameters.seed, parameters.first_ray)};
  std::vector<TaskHits> tasks((count + points_per_task - 1) / points_per_task);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t task) {
    const FlushDenormals flush_denormals;
    TaskHits& found = tasks[task];
    const std::size_t last = std::min(count, (task + 1) * points_per_task);
    for (std::size_t i = task * points_per_task; i < last; ++i) {
      const std::size_t before = found.ray_hits.hits.size();
      const std::size_t emission_before = found.ray_hits.emission.size();
      const std::size_t direct_before = found.ray_hits.direct.size();
      found.inverse_distances.push_back(trace_point(run, point_of(rays.scene(), points, first + i),
                                                    number[first + i],
                                                    static_cast<std::uint32_t>(i), found));
      found.direct_count.push_back(found.ray_hits.direct.size() - direct_before);
      found.count.push_back(found.ray_hits.hits.size() - before);
      found.emission_count.push_back(found.ray_hits.emission.size() - emission_before);
    }
  });
  return join(std::move(tasks));
}

}  // namespace photile::trace
