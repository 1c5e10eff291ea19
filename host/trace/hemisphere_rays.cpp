#include "trace/hemisphere_rays.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <optional>

#include "trace/flush_denormals.hpp"
#include "trace/hit_point.hpp"
#include "trace/sampling.hpp"
#include "trace/sobol.hpp"

namespace photile::trace {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task = 16;

struct TaskEnds {
  EyeRecord ends;
  std::vector<std::size_t> count, emission_count;  ///< of each point
};

/// All rays of a point.
///   run_point   its place in the run
void trace_point(const EyeSetup& setup, const HemisphereParameters& parameters,
                 const SurfacePoint& point, std::uint64_t number, std::uint32_t run_point,
                 EyeRecord& ends) {
  const auto batches = static_cast<std::uint32_t>(parameters.batches);
  const auto rays = static_cast<std::uint32_t>(parameters.rays);
  const RandomStream of_point(parameters.seed, number, 0);
  const Frame frame(point.normal);
  const glm::vec3 throughput(glm::pi<float>() / static_cast<float>(rays));
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    const RandomBlock scramble = of_point.block(Purpose::hemisphere_direction, batch);
    for (std::uint32_t i = 0; i < rays; ++i) {
      const glm::vec2 place(sobol_point(i, scramble));
      const glm::vec3 direction =
          frame.to_world(sample_cosine_hemisphere(std::min(place.x, 0x1.fffffep-1f), place.y));
      // A stream for each, apart from the point's own.
      const RandomStream random(parameters.seed, number, batch * rays + i + 1);
      std::optional<LampTechnique> looks;
      if (parameters.lamps) {
        const float cosine = std::max(0.0f, glm::dot(direction, point.normal));
        looks.emplace(*parameters.lamps,
                      parameters.rays_per_look * cosine * glm::one_over_pi<float>(), true);
      }
      follow_eye_ray(setup,
                     {point.origin_towards(direction), direction, throughput,
                      (run_point * batches + batch) * rays + i},
                     random, ends, looks ? &*looks : nullptr);
    }
  }
}

HemisphereRays join(std::vector<TaskEnds> tasks) {
  HemisphereRays all;
  all.first.push_back(0);
  all.first_emission.push_back(0);
  std::vector<std::size_t> first_of;
  const auto extend = [](std::vector<std::size_t>& first, const std::vector<std::size_t>& counts) {
    for (const std::size_t count : counts) first.push_back(first.back() + count);
  };
  for (const TaskEnds& task : tasks) {
    first_of.push_back(all.first.back());
    extend(all.first, task.count);
    extend(all.first_emission, task.emission_count);
    const std::vector<SeenEmission>& seen = task.ends.emission;
    all.ends.emission.insert(all.ends.emission.end(), seen.begin(), seen.end());
    all.ends.rays += task.ends.rays;
  }
  all.ends.hits.resize(all.first.back());
  const bool glossy = std::any_of(tasks.begin(), tasks.end(),
                                  [](const TaskEnds& task) { return !task.ends.glossy.empty(); });
  if (glossy) all.ends.glossy.resize(all.first.back());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t task) {
    const EyeRecord& ends = tasks[task].ends;
    const auto at = static_cast<std::ptrdiff_t>(first_of[task]);
    std::copy(ends.hits.begin(), ends.hits.end(), all.ends.hits.begin() + at);
    if (glossy) std::copy(ends.glossy.begin(), ends.glossy.end(), all.ends.glossy.begin() + at);
  });
  return all;
}

}  // namespace

HemisphereRays trace_hemispheres(const RayScene& rays, const PrimaryHits& points, std::size_t first,
                                 std::size_t count, std::span<const std::uint64_t> number,
                                 const HemisphereParameters& parameters) {
  PrimaryHitParameters specular;
  specular.max_specular_depth = parameters.max_specular_depth;
  const EyeSetup setup{.rays = &impl_of(rays),
                       .parameters = &specular,
                       .emitted_radiance = parameters.emitted_radiance,
                       .distant = parameters.lamps ? &parameters.lamps->distant() : nullptr};
  std::vector<TaskEnds> tasks((count + points_per_task - 1) / points_per_task);
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t task) {
    const FlushDenormals flush_denormals;
    TaskEnds& found = tasks[task];
    const std::size_t last = std::min(count, (task + 1) * points_per_task);
    for (std::size_t i = task * points_per_task; i < last; ++i) {
      const std::size_t before = found.ends.hits.size();
      const std::size_t emission_before = found.ends.emission.size();
      trace_point(setup, parameters, point_of(rays.scene(), points, first + i), number[first + i],
                  static_cast<std::uint32_t>(i), found.ends);
      found.count.push_back(found.ends.hits.size() - before);
      found.emission_count.push_back(found.ends.emission.size() - emission_before);
    }
  });
  return join(std::move(tasks));
}

}  // namespace photile::trace
