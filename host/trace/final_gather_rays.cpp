#include "trace/final_gather_rays.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "trace/eye_path.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/hit_batch.hpp"
#include "trace/hit_order.hpp"
#include "trace/hit_point.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/scatter.hpp"
#include "trace/sobol.hpp"

namespace photile::trace {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t hits_per_task = 16;

/// Blocks of random numbers that the direction of a ray takes.
enum DirectionBlock : std::uint32_t {
  gather_lobe_block,
  gather_place_block,
  gather_scramble_block
};

/// What a task's rays found.
struct TaskRays {
  std::vector<std::size_t> count;  ///< of each primary hit: rays that ended on a surface
  std::vector<LightWeights> weight;
  EyeRecord record;
};

/// All rays of one primary hit.
class FinalGatherer {
 public:
  FinalGatherer(const EyeSetup& setup, const FinalGatherParameters& parameters,
                const PrimaryHits& hits, std::size_t hit)
      : setup_(setup),
        parameters_(parameters),
        point_(point_of(*setup.rays->scene, hits, hit)),
        bsdf_(bsdf_of(*setup.rays->scene, hits, hit, point_)) {}

  void trace(std::uint64_t number, TaskRays& found) const {
    const Receiver receiver(point_, bsdf_);
    const RandomBlock scramble = RandomStream(parameters_.seed, number, 0)
                                     .block(Purpose::gather_direction, gather_scramble_block);
    std::size_t count = 0;
    for (int ray = 0; ray < parameters_.rays; ++ray) {
      // A stream for each, apart from the primary ray's, which is 0.
      const RandomStream random(parameters_.seed, number, static_cast<std::uint32_t>(ray) + 1);
      const auto direction =
          receiver.sample(random.block(Purpose::gather_direction, gather_lobe_block),
                          place_of(random, sobol_point(static_cast<std::uint32_t>(ray), scramble)));
      if (!direction) continue;
      const float density = receiver.density(*direction);
      if (!(density > 0.0f)) continue;
      const std::size_t before = found.record.hits.size();
      follow_eye_ray(setup_, {point_.origin_towards(*direction), *direction, glm::vec3(1.0f), 0},
                     random, found.record);
      if (found.record.hits.size() == before) continue;
      const float share = 1.0f / (density * static_cast<float>(parameters_.rays));
      found.weight.push_back(receiver.weights(*direction) *
                             (share * found.record.hits.back().throughput));
      ++count;
    }
    found.count.push_back(count);
  }

 private:
  /// Numbers for a direction.
  static RandomBlock place_of(const RandomStream& random, const glm::dvec2& place) {
    return random.block(Purpose::gather_direction, gather_place_block)
        .with(direction_word, place.x)
        .with(direction_word + 1, place.y);
  }

  const EyeSetup& setup_;
  const FinalGatherParameters& parameters_;
  SurfacePoint point_;
  OpaqueBsdf bsdf_;
};

/// The rays of all tasks, in their order.
FinalGatherRays join(const RayScene& rays, std::vector<TaskRays> tasks,
                     std::span<const std::uint32_t> map_of) {
  FinalGatherRays result;
  result.first.push_back(0);
  std::vector<EyeRecord> records;
  std::vector<std::uint32_t> first_of{0};  // hit of each task
  for (TaskRays& task : tasks) {
    for (const std::size_t count : task.count) result.first.push_back(result.first.back() + count);
    result.weight.insert(result.weight.end(), task.weight.begin(), task.weight.end());
    result.traced += task.record.rays;
    first_of.push_back(first_of.back() + static_cast<std::uint32_t>(task.record.hits.size()));
    records.push_back(std::move(task.record));
  }
  const std::vector<HitPlace> places = sorted_places(records, impl_of(rays).bounds, map_of);
  result.ends = hits_at(records, places);
  result.end.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    result.end[first_of[places[i].record] + places[i].index] = static_cast<std::uint32_t>(i);
  }
  return result;
}

}  // namespace

FinalGatherRays trace_final_gather(const RayScene& rays, const PrimaryHits& hits, std::size_t first,
                                   std::size_t count, std::span<const std::uint64_t> number,
                                   const FinalGatherParameters& parameters,
                                   std::span<const std::uint32_t> map_of) {
  PrimaryHitParameters specular;
  specular.max_specular_depth = parameters.max_specular_depth;
  const EyeSetup setup{.rays = &impl_of(rays), .parameters = &specular};
  std::vector<TaskRays> tasks((count + hits_per_task - 1) / hits_per_task);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t task) {
    const FlushDenormals flush_denormals;
    const std::size_t last = std::min(count, (task + 1) * hits_per_task);
    for (std::size_t i = task * hits_per_task; i < last; ++i) {
      FinalGatherer(setup, parameters, hits, first + i).trace(number[first + i], tasks[task]);
    }
  });
  return join(rays, std::move(tasks), map_of);
}

}  // namespace photile::trace
