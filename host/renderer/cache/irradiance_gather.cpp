#include "cache/irradiance_gather.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <string>
#include <utility>

#include "cache/ray_ends.hpp"
#include "cache/run_light.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "light/table_bytes.hpp"
#include "photile/communicator.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "trace/bright_surface.hpp"
#include "trace/hemisphere_rays.hpp"
#include "trace/ray_query.hpp"

namespace photile::cache {
namespace {

/// Rays of a run: enough to fill a device with new nodes and for all cores to wait little between
/// its steps, little enough for its data, some 150 bytes a ray, to be a small part of memory.
/// Processes that share the work take runs together, and may differ in their cores.
std::size_t rays_at_a_time(bool shared) {
  constexpr std::size_t of_a_core = std::size_t{1} << 17, most = of_a_core << 4;
  if (shared) return 2 * of_a_core;
  return std::min(most,
                  of_a_core * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
}

/// Whole rays of a batch.
int per_batch(int all, int batches) { return (all + batches - 1) / batches; }

/// Of an estimate by k photons by chance: a cone has 1.5 times the variance of a count
/// (docs/method/density.md).
double caustic_relative_variance(int neighbours) { return 1.5 / neighbours; }

std::vector<std::byte> bytes_of(const GatheredParts& parts) {
  ByteWriter bytes;
  light::put(parts.indirect, bytes);
  light::put(parts.direct, bytes);
  bytes.put(parts.distance);
  return bytes.take();
}

/// The points that follow.
void append(std::span<const std::byte> bytes, GatheredParts& all) {
  ByteReader reader(bytes);
  light::append(reader, all.indirect);
  light::append(reader, all.direct);
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
                                   const LightMapParameters& ends, light::LightAtPoints* caustics,
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
      of_ends_(photons),
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
      gather_own(estimate::reordered(points, own), number.subspan(begin, own.size()), rays,
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
  const std::size_t at_a_time = std::max<std::size_t>(
      1, rays_at_a_time(ends_.processes() != nullptr) / std::max<std::size_t>(64, rays_per_point));
  GatheredRuns sums;
  for (std::size_t round = 0; round < most; round += at_a_time) {
    progress.throw_if_cancelled();
    const std::size_t first = std::min(round, points.size());
    const std::size_t count = std::min(at_a_time, points.size() - first);
    RayEnds traced;
    if (rays_per_batch > 0) {
      traced =
          light_at_ends(trace::trace_hemispheres(rays_, points, first, count, number, hemisphere),
                        photons_, ends_, progress);
      costs_.rays += traced.rays.ray_hits.rays;
      costs_.hits += traced.slot.size();
      costs_.estimated += traced.found.size();
    }
    const RunLight run{
        .rays = rays_,
        .light_sampler = light_sampler_,
        .parameters = parameters_,
        .rays_per_batch = rays_per_batch,
        .light_samples_per_batch = light_samples_per_batch,
        .most_light_samples_per_batch = most_light_samples_per_batch,
        // Earlier rounds may have taken up to this factor more, where light was uncertain.
        .first_light_sample = static_cast<std::uint32_t>(
            defaults::light_samples_again * per_batch(before.light_samples, parameters_.batches)),
        .points = points,
        .number = number,
        .traced = rays_per_batch > 0 ? &traced : nullptr,
        .of_ends = ends_.values(),
        .caustics = caustics,
        .caustic_relative_variance =
            caustics_ ? caustic_relative_variance(parameters_.caustic_neighbours) : 0.0,
        .layer_powers = layer_powers_};
    add_sums(run, first, count, sums);
  }
  costs_.estimated += ends_.statistics().nodes - nodes_before;
  GatheredParts none = none_yet();
  return {light::joined(std::move(none.indirect), std::move(sums.indirect)),
          light::joined(std::move(none.direct), std::move(sums.direct)), std::move(sums.distance)};
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
