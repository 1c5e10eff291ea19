#include "gather/irradiance_gather.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <string>
#include <utility>

#include "estimate/map_order.hpp"
#include "gather/batch_sums.hpp"
#include "gather/end_cells.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "render/reflected_radiance.hpp"
#include "trace/diffuse_part.hpp"
#include "trace/direct_light.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/hemisphere_rays.hpp"
#include "trace/hit_batch.hpp"
#include "trace/hit_point.hpp"
#include "trace/largest.hpp"

namespace photile {
namespace {

using gathering::BatchSums;
using gathering::EndCells;

/// Enough to fill a device with new cells, little enough to stay in the processor's caches.
constexpr std::size_t rays_at_a_time = std::size_t{1} << 16;
/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 16;
/// Lobes that reflect more of the light towards the ray need directions: photons at the end itself.
constexpr float strong_lobe = 0.2f;
/// Marks estimates of an end alone in IndirectLight::estimate; other numbers are cells.
constexpr std::uint32_t own_estimate = 0x8000'0000u;

/// Whole rays of a batch.
int per_batch(int all, int batches) { return (all + batches - 1) / batches; }

/// What an end's surface reflects towards the ray of light that is the same from everywhere.
struct EndReflection {
  glm::vec3 reflectance;
  bool strong_lobe;
};

EndReflection reflection_of(const trace::EyeRecord& ends, std::size_t end) {
  const glm::vec3& albedo = ends.hits[end].diffuse_albedo;
  if (ends.glossy.empty() || ends.glossy[end].lobe.f90 == 0.0f) return {albedo, false};
  const trace::GlossyEyeHit& glossy = ends.glossy[end];
  const scene_io::Reflectance surface{albedo, glossy.lobe.specular, glossy.lobe.f90,
                                      glossy.lobe.roughness};
  const float cosine = std::max(glm::dot(glossy.lobe.normal, glossy.outgoing), 1e-6f);
  PhotileAlbedoFit fit;
  photile_albedo_fit(surface.alpha, &fit);
  float f0_weight = 0, f90_weight = 0;
  photile_lobe_albedo(&fit, cosine, &f0_weight, &f90_weight);
  const glm::vec3 lobe = f0_weight * surface.f0 + f90_weight * surface.f90;
  return {lobe + diffuse_reflectance(diffuse_part(surface, cosine), surface.alpha),
          trace::largest(lobe) > strong_lobe};
}

/// Photon estimates at some of the ends of a record.
struct EndEstimates {
  PrimaryHits hits;
  Estimates estimates;  ///< in the order of the ends that were asked for
};

EndEstimates estimates_at(MapEstimators& photons, const RayScene& rays,
                          const trace::EyeRecord& ends, std::span<const std::uint32_t> chosen) {
  trace::EyeRecord record;
  for (const std::uint32_t end : chosen) {
    record.hits.push_back(ends.hits[end]);
    if (!ends.glossy.empty()) record.glossy.push_back(ends.glossy[end]);
  }
  const std::span<const trace::EyeRecord> records(&record, 1);
  const std::vector<trace::HitPlace> places =
      trace::sorted_places(records, impl_of(rays).bounds, photons.map_of());
  std::vector<std::uint32_t> order;
  for (const trace::HitPlace& place : places) order.push_back(place.index);
  Estimates in_order = photons.estimate(trace::hits_at(records, places));
  std::vector<trace::HitPlace> as_chosen;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) as_chosen.push_back({0, i});
  return {trace::hits_at(records, as_chosen),
          estimate::restored(std::move(in_order), order, rays.needs().light_count)};
}

/// The light of surfaces around a run of points.
struct IndirectLight {
  trace::HemisphereRays rays;
  std::vector<std::uint32_t> estimate;  ///< of each end: a cell, or one of its own
  std::vector<glm::vec3> weight;        ///< of each end: of the cell's irradiance, or of radiance
  EndEstimates own;                     ///< of the run

  /// Adds what the rays of the run's point see.
  ///   cells           irradiance in all cells
  ///   rays_per_batch  of which some may have ended nowhere
  void add_point(std::size_t point, const Estimates& cells, std::uint32_t batches,
                 std::uint32_t rays_per_batch, std::size_t lights, BatchSums& sums) const {
    for (std::size_t end = rays.first[point]; end < rays.first[point + 1]; ++end) {
      const std::uint32_t batch = rays.ends.hits[end].pixel / rays_per_batch % batches;
      if (estimate[end] & own_estimate) {
        const std::size_t hit = estimate[end] & ~own_estimate;
        for_each_estimate(own.estimates, hit, lights, [&](std::size_t layer, std::size_t i) {
          sums.add(static_cast<std::uint32_t>(layer), batch,
                   weight[end] * reflected_radiance(own.hits, hit, own.estimates, i));
        });
      } else {
        for_each_estimate(cells, estimate[end], lights, [&](std::size_t layer, std::size_t i) {
          sums.add(static_cast<std::uint32_t>(layer), batch, weight[end] * cells.irradiance[i]);
        });
      }
    }
  }
};

/// Irradiance in cells where rays end, found when the first ends there.
class CellLight {
 public:
  CellLight(const RayScene& rays, MapEstimators& photons, double side,
            IrradianceGather::Costs& costs)
      : rays_(rays), photons_(photons), side_(side), costs_(costs) {}

  const Estimates& irradiance() const { return irradiance_; }

  /// Finds an estimate for each end.
  ///   points, first   the points and the first of the run that the rays left
  IndirectLight look_up(trace::HemisphereRays rays, const PrimaryHits& points, std::size_t first) {
    const Stopwatch stopwatch;
    IndirectLight light{.rays = std::move(rays), .estimate = {}, .weight = {}, .own = {}};
    std::vector<gathering::CellKey> keys;
    std::vector<std::uint8_t> has_own;
    classify(light, points, first, keys, has_own);
    EndCells::Numbers numbers = cells_.number(keys, has_own);
    light.estimate = std::move(numbers.cell);
    std::vector<std::uint32_t> own;
    for (std::uint32_t end = 0; end < has_own.size(); ++end) {
      if (!has_own[end]) continue;
      light.estimate[end] = own_estimate | static_cast<std::uint32_t>(own.size());
      own.push_back(end);
    }
    costs_.cell_seconds += stopwatch.seconds();

    const Stopwatch estimate_watch;
    const trace::EyeRecord& ends = light.rays.ends;
    Estimates fresh = estimates_at(photons_, rays_, ends, numbers.first_key).estimates;
    fresh.radiance.clear();  // towards one of the rays alone
    irradiance_.append(std::move(fresh));
    if (!own.empty()) light.own = estimates_at(photons_, rays_, ends, own);
    costs_.estimated += numbers.first_key.size() + own.size();
    costs_.ends += ends.hits.size();
    costs_.rays += ends.rays;
    costs_.estimate_seconds += estimate_watch.seconds();
    return light;
  }

 private:
  /// Finds the cells of ends, which ends have estimates of their own instead, and what estimates
  /// weigh at each.
  void classify(IndirectLight& light, const PrimaryHits& points, std::size_t first,
                std::vector<gathering::CellKey>& keys, std::vector<std::uint8_t>& has_own) const {
    const trace::HemisphereRays& rays = light.rays;
    const std::size_t count = rays.ends.hits.size();
    light.weight.resize(count);
    keys.resize(count);
    has_own.resize(count);
    const std::span<const std::uint32_t> map_of = photons_.map_of();
    tbb::parallel_for(std::size_t{0}, rays.first.size() - 1, [&](std::size_t point) {
      const trace::FlushDenormals flush_denormals;
      const glm::vec3 from = points.position[first + point];
      for (std::size_t end = rays.first[point]; end < rays.first[point + 1]; ++end) {
        const trace::EyeHit& hit = rays.ends.hits[end];
        const EndReflection reflection = reflection_of(rays.ends, end);
        has_own[end] = reflection.strong_lobe;
        light.weight[end] = hit.throughput;
        if (reflection.strong_lobe) continue;
        light.weight[end] *= reflection.reflectance * glm::one_over_pi<float>();
        const std::uint32_t sided = hit.sided_triangle;
        keys[end] = gathering::cell_of(hit.position, normal_of(sided),
                                       map_of.empty() ? sided : map_of[sided], side_,
                                       glm::distance(from, hit.position));
      }
    });
  }

  /// In single precision: enough to tell directions apart.
  glm::vec3 normal_of(std::uint32_t sided) const {
    const auto [a, b, c] = rays_.scene().corners(triangle_of(sided));
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    return side_of(sided) == 0 ? normal : -normal;
  }

  const RayScene& rays_;
  MapEstimators& photons_;
  double side_;
  IrradianceGather::Costs& costs_;
  EndCells cells_;
  Estimates irradiance_;  ///< of each cell
};

/// What the sums of a run of points are made of.
struct RunLight {
  const RayScene& rays;
  const trace::LightSampler& lamps;
  const IrradianceGatherParameters& parameters;
  const PrimaryHits& points;
  std::span<const std::uint64_t> number;
  const IndirectLight* indirect;  ///< null where no ray looks for it
  const Estimates& cells;
  const Estimates& caustics;  ///< of all points; empty where there are none
  double caustic_relative_variance;

  /// Of the run's point i, which is `point` of all.
  void add_point(std::size_t i, std::size_t point, BatchSums& sums) const {
    const auto batches = static_cast<std::uint32_t>(parameters.batches);
    const std::size_t lights = rays.needs().light_count;
    if (indirect) {
      const int rays_per_batch = per_batch(parameters.rays, parameters.batches);
      indirect->add_point(i, cells, batches, static_cast<std::uint32_t>(rays_per_batch), lights,
                          sums);
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
  CellLight cells(rays_, photons_, parameters_.cell_side, costs_);
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
    const RunLight light{rays_,
                         lamps_,
                         parameters_,
                         ordered,
                         ordered_number,
                         rays_per_batch > 0 ? &indirect : nullptr,
                         cells.irradiance(),
                         caustics,
                         caustics_ ? 1.0 / caustics_->neighbours() : 0.0};
    for (std::size_t i = 0; i < count; ++i) {
      place_of[order[first + i]] = {static_cast<std::uint32_t>(parts.size() + i / points_per_task),
                                    static_cast<std::uint32_t>(i % points_per_task)};
    }
    for (GatheredIrradiance& part : sum_run(light, first, count)) parts.push_back(std::move(part));
    costs_.sum_seconds += sum_watch.seconds();
  }
  GatheredIrradiance result;
  result.batches = parameters_.batches;
  if (rays_.needs().many_lights()) result.mean.first.push_back(0);
  for (const auto& [part, point] : place_of) {
    result.append(parts[part], point, rays_.needs().light_count);
  }
  return result;
}

}  // namespace photile
