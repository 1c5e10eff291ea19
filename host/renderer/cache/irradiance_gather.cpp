#include "cache/irradiance_gather.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "cache/ray_ends.hpp"
#include "common/byte_stream.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "photile/communicator.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "trace/bright_surface.hpp"
#include "trace/direct_light.hpp"
#include "trace/hemisphere_rays.hpp"
#include "trace/hot_spots.hpp"
#include "trace/ray_query.hpp"
#include "trace/shading_point.hpp"

namespace photile::cache {
namespace {

/// Enough to fill a device with new nodes, little enough to stay in the processor's caches.
constexpr std::size_t rays_at_a_time = std::size_t{1} << 16;
/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 16;

/// Runs of points: enough that while one waits the others have work for all threads.
std::size_t runs_on_their_way() {
  return 2 + static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) / 4;
}

/// Whole rays of a batch.
int per_batch(int all, int batches) { return (all + batches - 1) / batches; }

/// Of an estimate by k photons by chance: a cone has 1.5 times the variance of a count
/// (docs/density.md).
double caustic_relative_variance(int neighbours) { return 1.5 / neighbours; }

/// The data that the sums of a run of points are made from.
struct RunLight {
  const RayScene& rays;
  const trace::LightSampler& light_sampler;
  const IrradianceGatherParameters& parameters;
  int rays_per_batch, light_samples_per_batch;
  int most_light_samples_per_batch;  ///< where light is uncertain
  std::uint32_t first_light_sample;  ///< of a batch
  const PrimaryHits& points;
  std::span<const std::uint64_t> number;
  const RayEnds* traced;       ///< null where no rays are
  const LightTable& of_ends;   ///< of the nodes that rays read where they end
  const LightTable& caustics;  ///< of all points; empty where there are none
  double caustic_relative_variance;
  std::span<const double> layer_powers;

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

/// The light of the points of a run, in their order, in parts that tasks wrote.
std::vector<GatheredParts> sums_of(const RunLight& light, std::size_t first, std::size_t count) {
  std::vector<GatheredParts> parts((count + points_per_task - 1) / points_per_task);
  const SceneNeeds& needs = light.rays.needs();
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const trace::FlushDenormals flush_denormals;
    GatheredParts& own = parts[part];
    const int batches = light.parameters.batches;
    BatchSums indirect(needs, batches, false, own.indirect);
    BatchSums direct(needs, batches, light.caustic_relative_variance > 0, own.direct);
    const std::size_t last = std::min(count, (part + 1) * points_per_task);
    for (std::size_t i = part * points_per_task; i < last; ++i) {
      if (needs.smooth_shading) {
        const glm::vec3 normal =
            trace::point_of(light.rays.scene(), light.points, first + i).normal;
        indirect.begin_point(normal);
        direct.begin_point(normal);
      }
      light.add_indirect(i, indirect);
      indirect.end_point();
      const std::size_t row = i - part * points_per_task;
      light.add_direct(i, first + i, own.indirect.total(row, light.layer_powers).luminance, direct);
      direct.end_point();
      own.distance.push_back(light.distance(i));
    }
  });
  return parts;
}

/// A run of points on its way.
struct Run {
  std::size_t first, count;
  trace::HemisphereRays rays;
  RayEnds ends;
  std::vector<GatheredParts> light;
};

void put(const LightTable& part, ByteWriter& bytes) {
  bytes.put(part.irradiance);
  bytes.put(part.by_normal);
  bytes.put(part.first);
  bytes.put(part.light);
  bytes.put(part.batch);
  bytes.put(part.shared_variance);
}

std::vector<std::byte> bytes_of(const GatheredParts& parts) {
  ByteWriter bytes;
  put(parts.indirect, bytes);
  put(parts.direct, bytes);
  bytes.put(parts.distance);
  return bytes.take();
}

void append(ByteReader& reader, LightTable& all) {
  LightTable part(all.lights, false);
  part.batches = all.batches;
  reader.append_to(part.irradiance);
  reader.append_to(part.by_normal);
  reader.append_to(part.first);
  reader.append_to(part.light);
  reader.append_to(part.batch);
  reader.append_to(part.shared_variance);
  all.append(std::move(part));
}

/// The points that follow.
void append(std::span<const std::byte> bytes, GatheredParts& all) {
  ByteReader reader(bytes);
  append(reader, all.indirect);
  append(reader, all.direct);
  reader.append_to(all.distance);
}

/// 1 for each oriented face of a slat: a chart narrower than `width` metres, with other surface in
/// front of it at a smaller distance than its width.
std::vector<std::uint8_t> slats(const RayScene& rays, const Charts& charts, double width) {
  const Scene& scene = rays.scene();
  const std::span<const std::uint32_t> chart_of = charts.chart_of();
  std::vector<std::uint8_t> is_slat(charts.size(), 0);
  tbb::parallel_for(std::size_t{0}, chart_of.size(), [&](std::size_t face) {
    const std::uint32_t chart = chart_of[face];
    if (chart == none || !(charts[chart].width() < width)) return;
    const auto oriented_face = static_cast<std::uint32_t>(face);
    const auto corners = scene.corners(triangle_of(oriented_face));
    const glm::vec3 reach =
        static_cast<float>(charts[chart].width()) * glm::vec3(face_normal(scene, oriented_face));
    const glm::vec3 sum = corners[0] + corners[1] + corners[2];
    for (const glm::vec3& corner : corners) {
      const glm::vec3 foot = (sum + 3.0f * corner) / 6.0f;
      if (!trace::occluded(rays, foot + defaults::visibility_ray_offset * reach, foot + reach)) {
        continue;
      }
      std::atomic_ref(is_slat[chart]).store(1, std::memory_order_relaxed);
      return;
    }
  });
  std::vector<std::uint8_t> of_faces;
  for (const std::uint32_t chart : chart_of) {
    of_faces.push_back(chart == none ? std::uint8_t{0} : is_slat[chart]);
  }
  return of_faces;
}

void check_range(const char* what, int value, int low, int high) {
  if (value < low || value > high)
    throw UsageError(std::string(what) + ": " + std::to_string(value) + " is not between " +
                     std::to_string(low) + " and " + std::to_string(high));
}

}  // namespace

IrradianceGather::IrradianceGather(const RayScene& rays, light::LightAtPoints& photons,
                                   light::LightAtPoints& of_nodes, const LightMapParameters& ends,
                                   light::LightAtPoints* caustics,
                                   const IrradianceGatherParameters& parameters)
    : rays_(rays),
      photons_(photons),
      caustics_(caustics),
      parameters_(parameters),
      light_sampler_(rays.scene()),
      emitted_(emitted_radiance_at_unit_power(rays.scene())),
      layer_powers_(light::layer_powers(rays.scene())),
      bright_(parameters.rays > 0 ? trace::bright_surface(rays, layer_powers_, parameters.seed)
                                  : trace::Targets({})),
      of_ends_(of_nodes),
      ends_(rays, ends, of_ends_, LightMaps::Visibility::of_cells) {
  check_range("gathering rays of a point", parameters.rays, 0, limits::max_gathering_rays);
  check_range("light samples from a point", parameters.light_samples, 0, limits::max_direct_rays);
  check_range("batches of rays", parameters.batches, 2, LightTable::max_batches);
}

GatheredParts IrradianceGather::gather(const PrimaryHits& points,
                                       std::span<const std::uint64_t> number, int rays,
                                       int light_samples, const Progress& progress,
                                       NodeRays before) {
  auto* const processes = ends_.processes();
  if (!processes) {
    return gather_own(points, number, rays, light_samples, before, points.size(), progress);
  }
  const Shard shard{processes->rank(), processes->size()};
  const std::uint64_t begin = shard.begin(points.size()), end = shard.end(points.size());
  std::vector<std::uint32_t> own(end - begin);
  std::iota(own.begin(), own.end(), static_cast<std::uint32_t>(begin));
  const std::size_t most = (points.size() + shard.count - 1) / shard.count;
  const GatheredParts part =
      gather_own(estimate::reordered(points, 0, own), number.subspan(begin, own.size()), rays,
                 light_samples, before, most, progress);
  GatheredParts all = none_yet();
  for (const auto& bytes : processes->gather(bytes_of(part))) append(bytes, all);
  return all;
}

GatheredParts IrradianceGather::gather_own(const PrimaryHits& points,
                                           std::span<const std::uint64_t> number, int rays,
                                           int light_samples, NodeRays before, std::size_t most,
                                           const Progress& progress) {
  const std::uint64_t nodes_before = ends_.statistics().nodes;
  const LightTable caustics = caustics_ ? caustics_->at(points, progress) : LightTable{};
  costs_.estimated += caustics_ ? points.size() : 0;

  const int rays_per_batch = per_batch(rays, parameters_.batches);
  const int light_samples_per_batch = per_batch(light_samples, parameters_.batches);
  // This round's part of the samples that all rounds may take.
  const int most_light_samples_per_batch =
      defaults::most_light_samples_again * light_samples /
      (std::max(1, before.light_samples + light_samples) * parameters_.batches);
  const float near = caustics_ ? 0.0f : static_cast<float>(parameters_.near);
  if (near > 0 && rays > 0 && points.size() > 0 && slats_.empty()) {
    slats_ = slats(rays_, ends_.charts(), near / 2);
  }
  const trace::HemisphereParameters hemisphere{
      .batches = parameters_.batches,
      .rays = rays_per_batch,
      .first_ray = static_cast<std::uint32_t>(per_batch(before.rays, parameters_.batches)),
      .seed = parameters_.seed,
      .max_specular_depth = parameters_.max_specular_depth,
      .light_sampler = &light_sampler_,
      .emitted_radiance = &emitted_,
      .rays_per_light_sample =
          light_samples_per_batch > 0
              ? static_cast<float>(rays_per_batch) / static_cast<float>(light_samples_per_batch)
              : 0.0f,
      .near = near,
      .slats = slats_,
      .bright = &bright_};
  const auto rays_per_point = static_cast<std::size_t>(rays_per_batch * parameters_.batches);
  const std::size_t at_a_time =
      std::max<std::size_t>(1, rays_at_a_time / std::max<std::size_t>(64, rays_per_point));
  GatheredParts all = none_yet();
  // Several runs are on their way: while one has its ends looked up, which changes the light maps
  // and may take the device, rays of later ones are traced and earlier ones are summed.
  using RunPointer = std::shared_ptr<Run>;
  std::size_t round = 0;
  const auto begin = [&](tbb::flow_control& control) -> RunPointer {
    if (round >= most) {
      control.stop();
      return nullptr;
    }
    progress.throw_if_cancelled();
    const std::size_t first = std::min(round, points.size());
    round += at_a_time;
    return std::make_shared<Run>(
        Run{first, std::min(at_a_time, points.size() - first), {}, {}, {}});
  };
  const auto trace_rays = [&](RunPointer run) {
    if (rays_per_batch > 0) {
      run->rays =
          trace::trace_hemispheres(rays_, points, run->first, run->count, number, hemisphere);
    }
    return run;
  };
  const auto read_ends = [&](RunPointer run) {
    if (rays_per_batch == 0) return run;
    run->ends = light_at_ends(std::move(run->rays), photons_, ends_, progress);
    costs_.rays += run->ends.rays.ray_hits.rays;
    costs_.hits += run->ends.slot.size();
    costs_.estimated += run->ends.found.size();
    return run;
  };
  const auto sum = [&](RunPointer run) {
    const auto stays = ends_.hold_values();
    // A thread that holds the values must not take up a look-up while it waits for its tasks.
    tbb::this_task_arena::isolate([&] {
      run->light = sums_of(
          {.rays = rays_,
           .light_sampler = light_sampler_,
           .parameters = parameters_,
           .rays_per_batch = rays_per_batch,
           .light_samples_per_batch = light_samples_per_batch,
           .most_light_samples_per_batch = most_light_samples_per_batch,
           // Earlier rounds may have taken up to this factor more, where light was uncertain.
           .first_light_sample =
               static_cast<std::uint32_t>(defaults::light_samples_again *
                                          per_batch(before.light_samples, parameters_.batches)),
           .points = points,
           .number = number,
           .traced = rays_per_batch > 0 ? &run->ends : nullptr,
           .of_ends = ends_.values(),
           .caustics = caustics,
           .caustic_relative_variance =
               caustics_ ? caustic_relative_variance(parameters_.caustic_neighbours) : 0.0,
           .layer_powers = layer_powers_},
          run->first, run->count);
    });
    run->ends = {};
    return run;
  };
  const auto append_run = [&](const RunPointer& run) {
    for (GatheredParts& part : run->light) {
      all.indirect.append(std::move(part.indirect));
      all.direct.append(std::move(part.direct));
      all.distance.insert(all.distance.end(), part.distance.begin(), part.distance.end());
    }
  };
  using tbb::filter_mode;
  tbb::parallel_pipeline(
      runs_on_their_way(),
      tbb::make_filter<void, RunPointer>(filter_mode::serial_in_order, begin) &
          tbb::make_filter<RunPointer, RunPointer>(filter_mode::parallel, trace_rays) &
          tbb::make_filter<RunPointer, RunPointer>(filter_mode::serial_in_order, read_ends) &
          tbb::make_filter<RunPointer, RunPointer>(filter_mode::parallel, sum) &
          tbb::make_filter<RunPointer, void>(filter_mode::serial_in_order, append_run));
  costs_.estimated += ends_.statistics().nodes - nodes_before;
  return all;
}

GatheredParts IrradianceGather::none_yet() const {
  LightTable none(rays_.needs());
  none.batches = parameters_.batches;
  return {none, none, {}};
}

LightTable IrradianceGather::gather(const PrimaryHits& points,
                                    std::span<const std::uint64_t> number,
                                    const Progress& progress) {
  const GatheredParts parts =
      gather(points, number, parameters_.rays, parameters_.light_samples, progress);
  return sum_of(parts.indirect, parts.direct);
}

}  // namespace photile::cache
