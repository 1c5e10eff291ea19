#include "cache/run_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "trace/direct_light.hpp"
#include "trace/hot_spots.hpp"
#include "trace/ray_query.hpp"
#include "trace/shading_point.hpp"

namespace photile::cache {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t gathering_points_per_task = 16;

/// Adds up the light of one point of a run after another.
struct RunSums : RunLight {
  /// Adds the indirect light of point i of the run, which is `point` of all.
  void add_indirect(std::size_t i, BatchSums& sums) const {
    if (!traced) return;
    traced->add_point(of_ends, i, static_cast<std::uint32_t>(parameters.batches),
                      static_cast<std::uint32_t>(rays_per_batch), sums);
    const trace::HemisphereRays& met = traced->rays;
    for (std::size_t e = met.first_direct[i]; e < met.first_direct[i + 1]; ++e) {
      const VisibleEmission& light = met.ray_hits.direct[e];
      sums.add_surface(light.light, batch_of(light.pixel), light.radiance,
                       met.direction_of(light.pixel));
    }
  }
  ///   indirect   luminance of the irradiance of all lights together
  void add_direct(std::size_t i, std::size_t point, double indirect, BatchSums& sums) const {
    if (light_samples_per_batch > 0) {
      sample_lights(point, indirect, sums);
      add_visible_lights(i, sums);
    }
    if (caustics.irradiance.empty()) return;
    caustics.for_each(point, [&](std::size_t layer, std::size_t estimate) {
      sums.add_to_all(static_cast<std::uint32_t>(layer), caustics.irradiance[estimate],
                      caustic_relative_variance);
    });
  }
  /// Harmonic mean, metres.
  float distance(std::size_t i) const {
    if (!traced) return std::numeric_limits<float>::infinity();
    return static_cast<float>(rays_per_batch * parameters.batches) /
           traced->rays.inverse_distances[i];
  }

 private:
  std::uint32_t batch_of(std::uint32_t ray) const {
    return ray / static_cast<std::uint32_t>(rays_per_batch) %
           static_cast<std::uint32_t>(parameters.batches);
  }
  void sample_lights(std::size_t point, double indirect, BatchSums& sums) const {
    const trace::SurfacePoint where = trace::point_of(rays.scene(), points, point);
    const auto batches = static_cast<std::uint32_t>(parameters.batches);
    const auto samples_of = [&](std::uint32_t batch) {
      return trace::LightSampleNumbers(trace::RandomStream(parameters.seed, number[point], batch),
                                       first_light_sample);
    };
    if (traced) {
      const trace::HotSpots& hot_spots = trace::hot_spots_of(rays);
      const double exact = add_sampled_apart(where, sums);
      if (light_sampler.samples_all_apart()) return;
      thread_local trace::SelectionProbabilities probabilities;
      thread_local trace::ShadowRays first, more;
      light_sampler.weigh(where.position, where.normal, probabilities);
      // Rays that meet lights are weighted by the number of light samples that most points have.
      const auto rays_per_light_sample =
          static_cast<float>(rays_per_batch) / static_cast<float>(light_samples_per_batch);
      const auto found_by = [&](int begin, int end, trace::ShadowRays& light_samples) {
        light_samples.clear();
        for (std::uint32_t batch = 0; batch < batches; ++batch) {
          const trace::LightSampleNumbers samples = samples_of(batch);
          for (int i = begin; i < end; ++i) {
            const auto numbers = samples.light(static_cast<std::uint32_t>(i));
            const auto light = light_sampler.sample(where.position, numbers.choice,
                                                    numbers.position, probabilities);
            if (light && hot_spots.holds(light->light, where.position)) continue;
            light_samples.add(where, light, glm::vec3(1.0f), rays_per_light_sample, batch);
          }
        }
        return light_samples.found(rays);
      };
      const std::span<const trace::ShadowRays::Found> found =
          found_by(0, light_samples_per_batch, first);
      std::span<const trace::ShadowRays::Found> others;
      int count = light_samples_per_batch;
      const int most =
          std::min(defaults::light_samples_again * count, most_light_samples_per_batch);
      if (most > count && is_uncertain(found, indirect + exact)) {
        others = found_by(count, most, more);
        count = most;
      }
      const float weight = 1.0f / static_cast<float>(count);
      for (const auto& some : {found, others}) {
        for (const trace::ShadowRays::Found& light : some) {
          sums.add_light(light.layer, light.tag, weight * light.irradiance, light.direction);
        }
      }
      return;
    }
    thread_local std::vector<trace::ReceivedLight> found;
    for (std::uint32_t batch = 0; batch < batches; ++batch) {
      found.clear();
      trace::find_direct_light(rays, light_sampler, where, -where.normal, trace::ReflectedPart::all,
                               light_samples_per_batch, samples_of(batch), found);
      for (const trace::ReceivedLight& light : found) {
        sums.add_even(light.layer, batch, light.irradiance);
      }
    }
  }
  /// Adds to all batches the light of those lights that are sampled without chance. Returns its
  /// luminance.
  double add_sampled_apart(const trace::SurfacePoint& where, BatchSums& sums) const {
    thread_local trace::ShadowRays shadow_rays;
    const trace::HotSpots& hot_spots = trace::hot_spots_of(rays);
    double exact = 0;
    const auto add = [&](const trace::ShadowRays::Found& light) {
      exact += layer_powers[light.layer] * luminance(glm::dvec3(light.irradiance));
      for (int batch = 0; batch < parameters.batches; ++batch) {
        sums.add_light(light.layer, static_cast<std::uint32_t>(batch), light.irradiance,
                       light.direction);
      }
    };
    shadow_rays.clear();
    for (const std::uint32_t light : light_sampler.sampled_apart()) {
      if (rays.scene().lights[light].has_size() || hot_spots.holds(light, where.position)) continue;
      shadow_rays.add(where, light_sampler.towards(light, where.position), glm::vec3(1.0f), 0.0f,
                      0);
    }
    hot_spots.for_each_at(where.position, [&](std::uint32_t light) {
      if (!std::isfinite(parameters.resolution)) return;
      // As seen from below the surface, the light is at the distance that it is moved to. Its hot
      // spot, as far as it reaches, keeps the flux of a light that shines evenly.
      const double height = static_cast<double>(
          glm::dot(rays.scene().lights[light].position - where.position, where.normal));
      if (!(height > 0)) return;
      const double reach = hot_spots.reach(light),
                   raised = std::hypot(height, parameters.resolution);
      const double kept = 1 - raised / std::sqrt(raised * raised + reach * reach - height * height);
      const auto sunk = static_cast<float>(raised - height);
      shadow_rays.add(where, light_sampler.towards(light, where.position - sunk * where.normal),
                      glm::vec3(static_cast<float>((1 - height / reach) / kept)), 0.0f, 0);
    });
    for (const trace::ShadowRays::Found& light : shadow_rays.found(rays)) add(light);
    for (const std::uint32_t light : light_sampler.sampled_apart()) {
      if (!rays.scene().lights[light].has_size()) continue;
      if (const auto sun = shadow_rays.light_of_sun(light, rays, light_sampler, where)) add(*sun);
    }
    return exact;
  }
  /// Whether the scatter of the batches is a visible part of all light.
  ///   found    by the light samples of all points, each with a weight of 1
  ///   others   luminance of all other light
  bool is_uncertain(std::span<const trace::ShadowRays::Found> found, double others) const {
    if (found.empty()) return false;
    thread_local std::vector<double> of_batch;
    of_batch.assign(static_cast<std::size_t>(parameters.batches), 0.0);
    for (const auto& light : found) {
      of_batch[light.tag] += layer_powers[light.layer] * luminance(glm::dvec3(light.irradiance));
    }
    for (double& light : of_batch) light /= light_samples_per_batch;
    const auto count = static_cast<double>(of_batch.size());
    const double mean = std::accumulate(of_batch.begin(), of_batch.end(), 0.0) / count;
    double squares = 0;
    for (const double light : of_batch) squares += (light - mean) * (light - mean);
    const double tolerated = defaults::tolerated_light_sample_error * (mean + others);
    return squares > tolerated * tolerated * count * (count - 1);
  }
  void add_visible_lights(std::size_t i, BatchSums& sums) const {
    if (!traced) return;
    const trace::HemisphereRays& met = traced->rays;
    for (std::size_t e = met.first_emission[i]; e < met.first_emission[i + 1]; ++e) {
      const VisibleEmission& light = met.ray_hits.emission[e];
      sums.add_light(light_sampler.layer(light.light), batch_of(light.pixel), light.radiance,
                     met.direction_of(light.pixel));
    }
  }
};

}  // namespace

void add_sums(const RunLight& run, std::size_t first, std::size_t count, GatheredRuns& sums) {
  const RunSums light{run};
  const std::size_t before = sums.indirect.size(),
                    parts = (count + gathering_points_per_task - 1) / gathering_points_per_task;
  sums.indirect.resize(before + parts);
  sums.direct.resize(before + parts);
  sums.distance.resize(first + count);
  const SceneNeeds& needs = run.rays.needs();
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
    const trace::FlushDenormals flush_denormals;
    const int batches = run.parameters.batches;
    LightTable& of_surfaces = sums.indirect[before + part];
    BatchSums indirect(needs, batches, false, of_surfaces);
    BatchSums direct(needs, batches, run.caustic_relative_variance > 0, sums.direct[before + part]);
    const std::size_t last = std::min(count, (part + 1) * gathering_points_per_task);
    for (std::size_t i = part * gathering_points_per_task; i < last; ++i) {
      if (needs.smooth_shading) {
        const glm::vec3 normal = trace::point_of(run.rays.scene(), run.points, first + i).normal;
        indirect.begin_point(normal);
        direct.begin_point(normal);
      }
      light.add_indirect(i, indirect);
      indirect.end_point();
      const std::size_t row = i - part * gathering_points_per_task;
      light.add_direct(i, first + i, of_surfaces.total(row, run.layer_powers).luminance, direct);
      direct.end_point();
      sums.distance[first + i] = light.distance(i);
    }
  });
}

}  // namespace photile::cache
