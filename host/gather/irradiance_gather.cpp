#include "gather/irradiance_gather.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "estimate/map_order.hpp"
#include "gather/batch_sums.hpp"
#include "gather/cell_light.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "render/reflected_radiance.hpp"
#include "trace/direct_light.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/hemisphere_rays.hpp"
#include "trace/hit_point.hpp"

namespace photile {
namespace {

using gathering::BatchSums;
using gathering::CellLight;
using gathering::IndirectLight;

/// Enough to fill a device with new cells, little enough to stay in the processor's caches.
constexpr std::size_t rays_at_a_time = std::size_t{1} << 16;
/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 16;

/// Whole rays of a batch.
int per_batch(int all, int batches) { return (all + batches - 1) / batches; }

/// What the sums of a run of points are made of.
struct RunLight {
  const RayScene& rays;
  const trace::LightSampler& lamps;
  const IrradianceGatherParameters& parameters;
  const PrimaryHits& points;
  std::span<const std::uint64_t> number;
  const IndirectLight* indirect;  ///< null where no ray looks for it
  const CellLight& cells;
  const Estimates& caustics;  ///< of all points; empty where there are none
  double caustic_relative_variance;

  /// Of the run's point i, which is `point` of all.
  void add_point(std::size_t i, std::size_t point, BatchSums& sums) const {
    const auto batches = static_cast<std::uint32_t>(parameters.batches);
    const std::size_t lights = rays.needs().light_count;
    if (indirect) {
      const int rays_per_batch = per_batch(parameters.rays, parameters.batches);
      cells.add_point(*indirect, i, batches, static_cast<std::uint32_t>(rays_per_batch), sums);
    }
    if (parameters.looks > 0) add_direct_light(point, batches, sums);
    if (caustics.irradiance.empty()) return;
    for_each_estimate(caustics, point, lights, [&](std::size_t layer, std::size_t estimate) {
      sums.add_to_all(static_cast<std::uint32_t>(layer), caustics.irradiance[estimate],
                      caustic_relative_variance);
    });
  }

 private:
  void add_direct_light(std::size_t point, std::uint32_t batches, BatchSums& sums) const {
    thread_local std::vector<trace::ReceivedLight> found;
    const trace::SurfacePoint where = trace::point_of(rays.scene(), points, point);
    for (std::uint32_t batch = 0; batch < batches; ++batch) {
      found.clear();
      const trace::LookSamples samples(trace::RandomStream(parameters.seed, number[point], batch),
                                       0);
      trace::find_direct_light(rays, lamps, where, -where.normal, false,
                               per_batch(parameters.looks, parameters.batches), samples, found);
      for (const trace::ReceivedLight& light : found)
        sums.add(light.layer, batch, light.irradiance);
    }
  }
};

/// The points of a run summed up, a part for each task, in their order.
std::vector<GatheredIrradiance> sum_run(const RunLight& light, std::size_t first,
                                        std::size_t count) {
  std::vector<GatheredIrradiance> parts((count + points_per_task - 1) / points_per_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const trace::FlushDenormals flush_denormals;
    BatchSums sums(light.rays.needs(), light.parameters.batches, !light.caustics.irradiance.empty(),
                   parts[part]);
    const std::size_t last = std::min(count, (part + 1) * points_per_task);
    for (std::size_t i = part * points_per_task; i < last; ++i) {
      light.add_point(i, first + i, sums);
      sums.end_point();
    }
  });
  return parts;
}

void add(const CellLight::Costs& cells, IrradianceGather::Costs& costs) {
  costs.cell_seconds += cells.cell_seconds;
  costs.estimate_seconds += cells.estimate_seconds;
  costs.rays += cells.rays;
  costs.ends += cells.ends;
  costs.estimated += cells.estimated;
}

void check_range(const char* what, int value, int low, int high) {
  if (value < low || value > high)
    throw UsageError(std::string(what) + ": " + std::to_string(value) + " is not between " +
                     std::to_string(low) + " and " + std::to_string(high));
}

}  // namespace

IrradianceGather::IrradianceGather(const RayScene& rays, MapEstimators& photons,
                                   MapEstimators* caustics,
                                   const IrradianceGatherParameters& parameters)
    : rays_(rays),
      photons_(photons),
      caustics_(caustics),
      parameters_(parameters),
      lamps_(rays.scene()) {
  check_range("gathering rays of a point", parameters.rays, 0, limits::max_final_gather_rays);
  check_range("looks at lamps from a point", parameters.looks, 0, limits::max_direct_rays);
  check_range("batches of rays", parameters.batches, 2, 64);
  if (parameters.cell_side < 0 || !std::isfinite(parameters.cell_side)) {
    throw UsageError("side of cells: give a length in metres, or 0");
  }
  if (parameters_.cell_side == 0) parameters_.cell_side = 0.5 * photons.radius();
}

GatheredIrradiance IrradianceGather::gather(const PrimaryHits& points,
                                            std::span<const std::uint64_t> number,
                                            const Progress& progress) {
  // In the order of their numbers, so that the first end in a cell is that of lowest number.
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return number[a] < number[b]; });
  const PrimaryHits ordered = estimate::reordered(points, 0, order);
  std::vector<std::uint64_t> ordered_number;
  for (const std::uint32_t point : order) ordered_number.push_back(number[point]);

  const Stopwatch caustics_watch;
  const Estimates caustics = caustics_ ? caustics_->estimate(ordered) : Estimates{};
  costs_.estimate_seconds += caustics_watch.seconds();
  costs_.estimated += caustics_ ? ordered.size() : 0;

  const int rays_per_batch = per_batch(parameters_.rays, parameters_.batches);
  const trace::HemisphereParameters hemisphere{parameters_.batches, rays_per_batch,
                                               parameters_.seed, parameters_.max_specular_depth};
  CellLight cells(rays_, photons_, parameters_.cell_side);
  const auto rays_per_point = static_cast<std::size_t>(rays_per_batch * parameters_.batches);
  const std::size_t at_a_time =
      std::max<std::size_t>(1, rays_at_a_time / std::max<std::size_t>(64, rays_per_point));
  std::vector<GatheredIrradiance> parts;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> place_of(points.size());  // part, in it
  for (std::size_t first = 0; first < ordered.size(); first += at_a_time) {
    progress.throw_if_cancelled();
    const std::size_t count = std::min(at_a_time, ordered.size() - first);
    IndirectLight indirect;
    if (rays_per_batch > 0) {
      const Stopwatch stopwatch;
      trace::HemisphereRays traced =
          trace::trace_hemispheres(rays_, ordered, first, count, ordered_number, hemisphere);
      costs_.ray_seconds += stopwatch.seconds();
      indirect = cells.look_up(std::move(traced), ordered, first);
    }
    const Stopwatch sum_watch;
    const RunLight light{rays_,   lamps_,         parameters_,
                         ordered, ordered_number, rays_per_batch > 0 ? &indirect : nullptr,
                         cells,   caustics,       caustics_ ? 1.0 / caustics_->neighbours() : 0.0};
    for (std::size_t i = 0; i < count; ++i) {
      place_of[order[first + i]] = {static_cast<std::uint32_t>(parts.size() + i / points_per_task),
                                    static_cast<std::uint32_t>(i % points_per_task)};
    }
    for (GatheredIrradiance& part : sum_run(light, first, count)) parts.push_back(std::move(part));
    costs_.sum_seconds += sum_watch.seconds();
  }
  add(cells.costs(), costs_);
  GatheredIrradiance result;
  result.batches = parameters_.batches;
  if (rays_.needs().many_lights()) result.mean.first.push_back(0);
  for (const auto& [part, point] : place_of) {
    result.append(parts[part], point, rays_.needs().light_count);
  }
  return result;
}

}  // namespace photile
