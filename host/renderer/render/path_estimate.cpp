#include "render/path_estimate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "estimate/estimate_writer.hpp"
#include "render/surface_path.hpp"
#include "trace/ray_query.hpp"
#include "trace/receiver.hpp"

namespace photile::reference {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work and to stop soon.
constexpr std::size_t hits_per_chunk = 1024;

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
    estimate::EstimateWriter writer(needs_, parts[chunk]);
    std::vector<PathLight> found;
    const std::size_t last = std::min(hits.size(), (chunk + 1) * hits_per_chunk);
    for (std::size_t hit = chunk * hits_per_chunk; hit < last; ++hit) {
      const trace::SurfacePoint start = trace::point_of(rays_.scene(), hits, hit);
      const trace::RandomStream random(seed_, number[hit], 0);
      found.clear();
      const trace::OpaqueBsdf bsdf = trace::bsdf_of(rays_.scene(), hits, hit, start);
      trace_surface_path(rays_, lights_, start, bsdf, random, found);
      for (const PathLight& light : found) {
        writer.add(light.layer, light.irradiance, light.radiance);
      }
      writer.end_hit();
    }
  });
  Estimates all;
  if (needs_.many_lights()) all.first.push_back(0);
  for (Estimates& part : parts) all.append(std::move(part));
  return all;
}

}  // namespace photile::reference
