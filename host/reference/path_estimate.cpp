#include "reference/path_estimate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "reference/surface_path.hpp"
#include "trace/flush_denormals.hpp"

namespace photile::reference {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work and to stop soon.
constexpr std::size_t hits_per_chunk = 1024;

trace::SurfacePoint start_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit) {
  const std::uint32_t sided = hits.sided_triangle[hit];
  const glm::dvec3 position(hits.position[hit]);
  return trace::surface_point(
      scene, trace::nearest_on_triangle(scene, triangle_of(sided), position), side_of(sided));
}

/// Sums of each light in the form of Estimates.
class EstimateWriter {
 public:
  EstimateWriter(const SceneNeeds& needs, Estimates& estimates)
      : lights_(needs.light_count),
        sparse_(needs.many_lights()),
        glossy_(needs.glossy),
        estimates_(estimates) {
    if (sparse_) estimates_.first.push_back(0);
  }

  /// The next hit. Reorders `found`.
  void add(std::vector<PathLight>& found) {
    std::stable_sort(found.begin(), found.end(),
                     [](const PathLight& a, const PathLight& b) { return a.layer < b.layer; });
    std::uint32_t layer = 0;
    for (std::size_t i = 0; i < found.size();) {
      PathLight sum = found[i];
      for (++i; i < found.size() && found[i].layer == sum.layer; ++i) {
        sum.irradiance += found[i].irradiance;
        sum.radiance += found[i].radiance;
      }
      for (; !sparse_ && layer < sum.layer; ++layer) append({});
      append(sum);
      ++layer;
      if (sparse_) estimates_.light.push_back(static_cast<std::uint16_t>(sum.layer));
    }
    for (; !sparse_ && layer < lights_; ++layer) append({});
    if (sparse_) estimates_.first.push_back(estimates_.irradiance.size());
  }

 private:
  void append(const PathLight& sum) {
    estimates_.irradiance.push_back(sum.irradiance);
    if (glossy_) estimates_.radiance.push_back(sum.radiance);
  }

  std::uint32_t lights_;
  bool sparse_, glossy_;
  Estimates& estimates_;
};

}  // namespace

PathEstimator::PathEstimator(const RayScene& rays, std::uint64_t seed)
    : rays_(rays), seed_(seed), needs_(rays.needs()), lights_(rays.scene()) {}

Estimates PathEstimator::estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                                  const Progress& progress) const {
  const std::size_t chunks = (hits.size() + hits_per_chunk - 1) / hits_per_chunk;
  std::vector<Estimates> parts(chunks);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    progress.throw_if_cancelled();
    const trace::FlushDenormals flush_denormals;
    EstimateWriter writer(needs_, parts[chunk]);
    std::vector<PathLight> found;
    const std::size_t last = std::min(hits.size(), (chunk + 1) * hits_per_chunk);
    for (std::size_t hit = chunk * hits_per_chunk; hit < last; ++hit) {
      const trace::SurfacePoint start = start_of(rays_.scene(), hits, hit);
      // A Lambertian surface does not ask where it is seen from.
      const glm::vec3 direction = needs_.glossy ? -hits.outgoing[hit] : -start.normal;
      const trace::RandomStream random(seed_, number[hit], 0);
      found.clear();
      trace_surface_path(rays_, lights_, start, direction, random, found);
      writer.add(found);
    }
  });
  Estimates all;
  if (needs_.many_lights()) all.first.push_back(0);
  for (Estimates& part : parts) all.append(std::move(part));
  return all;
}

}  // namespace photile::reference
