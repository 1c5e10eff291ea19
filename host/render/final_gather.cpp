#include "render/final_gather.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "estimate/estimate_writer.hpp"
#include "photile/statistics.hpp"
#include "render/reflected_radiance.hpp"

namespace photile {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t hits_per_task = 256;

/// Sums of a run of primary hits: their caustics and the light of their rays, in this order.
class Sums {
 public:
  Sums(const SceneNeeds& needs, const PrimaryHits& hits, const Estimates& caustics,
       const trace::FinalGatherRays& rays, const Estimates& at_ends)
      : needs_(needs), hits_(hits), caustics_(caustics), rays_(rays), at_ends_(at_ends) {}

  /// Of hits [first + begin, first + end), where `first` is the first hit with rays.
  Estimates of(std::size_t first, std::size_t begin, std::size_t end) const {
    Estimates sums;
    estimate::EstimateWriter writer(needs_, sums);
    for (std::size_t i = begin; i < end; ++i) {
      add_caustics(first + i, writer);
      for (std::size_t ray = rays_.first[i]; ray < rays_.first[i + 1]; ++ray) add_ray(ray, writer);
      writer.end_hit();
    }
    return sums;
  }

 private:
  void add_caustics(std::size_t hit, estimate::EstimateWriter& writer) const {
    if (caustics_.irradiance.empty()) return;
    for_each_estimate(caustics_, hit, needs_.light_count, [&](std::size_t layer, std::size_t i) {
      writer.add(static_cast<std::uint32_t>(layer), caustics_.irradiance[i],
                 reflected_radiance(hits_, hit, caustics_, i));
    });
  }

  void add_ray(std::size_t ray, estimate::EstimateWriter& writer) const {
    const std::size_t end = rays_.end[ray];
    const trace::LightWeights& weight = rays_.weight[ray];
    for_each_estimate(at_ends_, end, needs_.light_count, [&](std::size_t layer, std::size_t i) {
      const glm::vec3 radiance = reflected_radiance(rays_.ends, end, at_ends_, i);
      writer.add(static_cast<std::uint32_t>(layer), weight.irradiance * radiance,
                 weight.radiance * radiance);
    });
  }

  const SceneNeeds& needs_;
  const PrimaryHits& hits_;
  const Estimates& caustics_;
  const trace::FinalGatherRays& rays_;
  const Estimates& at_ends_;
};

}  // namespace

Estimates FinalGather::estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                                std::int64_t ends_at_a_time, const Progress& progress) {
  const Estimates caustics = caustics_ ? caustics_->estimate(hits) : Estimates{};
  costs_.estimated += caustics_ ? hits.size() : 0;
  const auto at_a_time =
      static_cast<std::size_t>(std::max<std::int64_t>(1, ends_at_a_time / parameters_.rays));
  Estimates all;
  if (rays_.needs().many_lights()) all.first.push_back(0);
  for (std::size_t first = 0; first < hits.size(); first += at_a_time) {
    progress.throw_if_cancelled();
    all.append(gathered(hits, caustics, first, std::min(at_a_time, hits.size() - first), number));
  }
  return all;
}

Estimates FinalGather::gathered(const PrimaryHits& hits, const Estimates& caustics,
                                std::size_t first, std::size_t count,
                                std::span<const std::uint64_t> number) {
  const Stopwatch stopwatch;
  const trace::FinalGatherRays rays =
      trace::trace_final_gather(rays_, hits, first, count, number, parameters_, photons_.map_of());
  costs_.rays_time += stopwatch.taken();
  costs_.rays += rays.traced;
  costs_.estimated += rays.ends.size();
  const Estimates at_ends = photons_.estimate(rays.ends);
  const Sums sums(rays_.needs(), hits, caustics, rays, at_ends);
  std::vector<Estimates> parts((count + hits_per_task - 1) / hits_per_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t begin = part * hits_per_task;
    parts[part] = sums.of(first, begin, std::min(count, begin + hits_per_task));
  });
  Estimates all;
  if (rays_.needs().many_lights()) all.first.push_back(0);
  for (Estimates& part : parts) all.append(std::move(part));
  return all;
}

}  // namespace photile
