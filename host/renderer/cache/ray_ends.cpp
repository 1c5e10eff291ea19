#include "cache/ray_ends.hpp"

#include <tbb/parallel_for.h>

#include <glm/gtc/constants.hpp>
#include <utility>

#include "common/touched_memory.hpp"
#include "light/light_at_points.hpp"
#include "trace/hit_batch.hpp"
#include "trace/surface.hpp"

namespace photile::cache {
namespace {

/// Finds the weight of irradiance at each end. Returns 1 for those whose lobe reflects much, else
/// 0; their light is radiance.
std::vector<std::uint8_t> weigh(RayEnds& ends) {
  const trace::EyeRecord& ray_hits = ends.rays.ray_hits;
  std::vector<std::uint8_t> has_lobe(ray_hits.hits.size());
  ends.weight.resize(ray_hits.hits.size());
  tbb::parallel_for(std::size_t{0}, ends.rays.first.size() - 1, [&](std::size_t point) {
    const trace::FlushDenormals flush_denormals;
    for (std::size_t end = ends.rays.first[point]; end < ends.rays.first[point + 1]; ++end) {
      const trace::HitReflection reflection = trace::reflection_of(ray_hits, end);
      has_lobe[end] = reflection.strong_lobe;
      ends.weight[end] = ray_hits.hits[end].throughput;
      if (reflection.strong_lobe) continue;
      ends.weight[end] *= reflection.reflectance * glm::one_over_pi<float>();
    }
  });
  return has_lobe;
}

/// In the order of the ends that are chosen.
PrimaryHits hits_of(const trace::EyeRecord& ray_hits, std::span<const std::uint32_t> chosen) {
  trace::EyeRecord record;
  record.hits.resize(chosen.size());
  record.glossy.resize(ray_hits.glossy.empty() ? 0 : chosen.size());
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(chosen.size()),
                    [&](std::uint32_t i) {
                      record.hits[i] = ray_hits.hits[chosen[i]];
                      if (!record.glossy.empty()) record.glossy[i] = ray_hits.glossy[chosen[i]];
                    });
  return trace::hits_of({&record, 1});
}

}  // namespace

void RayEnds::add_point(const LightTable& of_nodes, std::size_t point, std::uint32_t batches,
                        std::uint32_t rays_per_batch, BatchSums& sums) const {
  for (std::size_t end = rays.first[point]; end < rays.first[point + 1]; ++end) {
    const trace::EyeHit& hit = rays.ray_hits.hits[end];
    const std::uint32_t batch = hit.pixel / rays_per_batch % batches;
    const glm::vec3 direction = rays.direction_of(hit.pixel);
    if (slot[end] < found.size()) {
      light.for_each(slot[end], [&](std::size_t layer, std::size_t i) {
        sums.add_surface(static_cast<std::uint32_t>(layer), batch,
                         weight[end] * light::reflected_radiance(found, slot[end], light, i),
                         direction);
      });
      continue;
    }
    const BilinearWeights& bilinear = nodes[slot[end] - found.size()];
    for (std::size_t corner = 0; corner < bilinear.node.size(); ++corner) {
      if (bilinear.weight[corner] == 0.0f) continue;
      const glm::vec3 of_corner = bilinear.weight[corner] * weight[end];
      of_nodes.for_each(bilinear.node[corner], [&](std::size_t layer, std::size_t i) {
        sums.add_surface(static_cast<std::uint32_t>(layer), batch,
                         of_corner * of_nodes.irradiance[i], direction);
      });
    }
  }
}

RayEnds light_at_ends(trace::HemisphereRays rays, light::LightAtPoints& photons, LightMaps& maps,
                      const Progress& progress) {
  RayEnds ends{
      .rays = std::move(rays), .weight = {}, .slot = {}, .found = {}, .light = {}, .nodes = {}};
  const trace::EyeRecord& ray_hits = ends.rays.ray_hits;
  std::vector<std::uint8_t> is_found = weigh(ends);
  const std::vector<std::uint32_t> served =
      numbers_where(is_found.size(), [&](std::uint32_t end) { return is_found[end] == 0; });
  PrimaryHits on_maps;
  on_maps.position.resize(served.size());
  on_maps.oriented_face.resize(served.size());
  tbb::parallel_for(std::size_t{0}, served.size(), [&](std::size_t i) {
    on_maps.position[i] = ray_hits.hits[served[i]].position;
    on_maps.oriented_face[i] = ray_hits.hits[served[i]].oriented_face;
  });
  LightMaps::Around around = maps.around(on_maps, progress);
  tbb::parallel_for(std::size_t{0}, served.size(), [&](std::size_t i) {
    if (around.seen[i]) return;
    is_found[served[i]] = 1;
    ends.weight[served[i]] = ray_hits.hits[served[i]].throughput;
  });
  const std::vector<std::uint32_t> chosen =
      numbers_where(is_found.size(), [&](std::uint32_t end) { return is_found[end] != 0; });
  ends.slot.resize(is_found.size());
  tbb::parallel_for(std::size_t{0}, served.size(), [&](std::size_t i) {
    ends.slot[served[i]] = static_cast<std::uint32_t>(chosen.size() + i);
  });
  tbb::parallel_for(std::size_t{0}, chosen.size(),
                    [&](std::size_t i) { ends.slot[chosen[i]] = static_cast<std::uint32_t>(i); });
  ends.nodes = std::move(around.nodes);
  if (!chosen.empty() || maps.processes()) {
    ends.found = hits_of(ray_hits, chosen);
    ends.light = photons.at(ends.found, progress);
  }
  return ends;
}

}  // namespace photile::cache
