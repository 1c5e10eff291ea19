#include "cache/secondary_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "cache/charts.hpp"
#include "estimate/map_order.hpp"
#include "light/light_at_points.hpp"
#include "trace/hit_batch.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::cache {
namespace {

/// The known visibility of the cells of the light maps.
constexpr std::uint8_t unknown_cell = 0, open_cell = 1, crossed_cell = 2;

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t hits_per_task = 1024;

}  // namespace

IndirectLight SecondaryLight::query(trace::HemisphereRays rays, const Progress& progress) {
  IndirectLight light{.rays = std::move(rays), .own_of = {}, .nodes = {}, .weight = {}, .own = {}};
  std::vector<std::uint8_t> has_own;
  classify(light, has_own);
  const trace::EyeRecord& ray_hits = light.rays.ray_hits;
  PrimaryHits served;
  for (std::size_t index = 0; index < has_own.size(); ++index) {
    if (has_own[index]) continue;
    served.position.push_back(ray_hits.hits[index].position);
    served.oriented_face.push_back(ray_hits.hits[index].oriented_face);
  }
  fill(served, progress);
  find_nodes(light, has_own);
  light.own_of.assign(ray_hits.hits.size(), none);
  std::vector<std::uint32_t> own;
  for (std::uint32_t index = 0; index < has_own.size(); ++index) {
    if (!has_own[index]) continue;
    light.own_of[index] = static_cast<std::uint32_t>(own.size());
    own.push_back(index);
  }
  if (!own.empty() || processes()) light.own = estimates_at(ray_hits, own, progress);
  costs_.estimated += own.size();
  costs_.hits += ray_hits.hits.size();
  costs_.rays += ray_hits.rays;
  return light;
}

std::vector<BilinearWeights> SecondaryLight::nodes_around(const PrimaryHits& hits,
                                                          const Progress& progress) {
  fill(hits, progress);
  std::vector<BilinearWeights> nodes(hits.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits.size(), hits_per_task),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t hit = range.begin(); hit < range.end(); ++hit) {
                        find(hits.oriented_face[hit], hits.position[hit], nodes[hit]);
                      }
                    });
  return nodes;
}

std::span<const std::uint8_t> SecondaryLight::slats(double width) {
  if (!slats_.empty()) return slats_;
  if (!maps_) maps_.emplace(rays_, parameters_);
  const Scene& scene = rays_.scene();
  const Charts& charts = maps_->maps.charts();
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
      if (!trace::occluded(rays_, foot + defaults::visibility_ray_offset * reach, foot + reach)) {
        continue;
      }
      std::atomic_ref(is_slat[chart]).store(1, std::memory_order_relaxed);
      return;
    }
  });
  for (const std::uint32_t chart : chart_of) {
    slats_.push_back(chart == none ? std::uint8_t{0} : is_slat[chart]);
  }
  return slats_;
}

std::uint64_t SecondaryLight::bytes() const {
  if (!maps_) return 0;
  const LightMapStatistics statistics = maps_->maps.statistics();
  return statistics.value_bytes + statistics.index_bytes;
}

SecondaryLight::Costs SecondaryLight::costs() const {
  Costs costs = costs_;
  costs.estimated += nodes_.valued();
  return costs;
}

void SecondaryLight::add_point(const IndirectLight& light, std::size_t point, std::uint32_t batches,
                               std::uint32_t rays_per_batch, BatchSums& sums) const {
  const LightTable& values = maps_->maps.values();
  for (std::size_t index = light.rays.first[point]; index < light.rays.first[point + 1]; ++index) {
    const trace::EyeHit& hit = light.rays.ray_hits.hits[index];
    const std::uint32_t batch = hit.pixel / rays_per_batch % batches;
    const glm::vec3 direction = light.rays.direction_of(hit.pixel);
    if (light.own_of[index] != none) {
      const SecondaryEstimates& own = light.own;
      own.estimates.for_each(light.own_of[index], [&](std::size_t layer, std::size_t i) {
        sums.add_surface(static_cast<std::uint32_t>(layer), batch,
                         light.weight[index] * light::reflected_radiance(
                                                   own.hits, light.own_of[index], own.estimates, i),
                         direction);
      });
      continue;
    }
    const BilinearWeights& bilinear = light.nodes[index];
    for (std::size_t corner = 0; corner < bilinear.node.size(); ++corner) {
      if (bilinear.weight[corner] == 0.0f) continue;
      const glm::vec3 weight = bilinear.weight[corner] * light.weight[index];
      values.for_each(bilinear.node[corner], [&](std::size_t layer, std::size_t i) {
        sums.add_surface(static_cast<std::uint32_t>(layer), batch, weight * values.irradiance[i],
                         direction);
      });
    }
  }
}

/// Finds which ray hits have separate estimates, and the weight of estimates at each.
void SecondaryLight::classify(IndirectLight& light, std::vector<std::uint8_t>& has_own) const {
  const trace::EyeRecord& ray_hits = light.rays.ray_hits;
  light.weight.resize(ray_hits.hits.size());
  has_own.resize(ray_hits.hits.size());
  tbb::parallel_for(std::size_t{0}, light.rays.first.size() - 1, [&](std::size_t point) {
    const trace::FlushDenormals flush_denormals;
    for (std::size_t index = light.rays.first[point]; index < light.rays.first[point + 1];
         ++index) {
      const trace::HitReflection reflection = trace::reflection_of(ray_hits, index);
      has_own[index] = reflection.strong_lobe;
      light.weight[index] = ray_hits.hits[index].throughput;
      if (reflection.strong_lobe) continue;
      light.weight[index] *= reflection.reflectance * glm::one_over_pi<float>();
    }
  });
}

/// Values the nodes that hits need.
void SecondaryLight::fill(const PrimaryHits& hits, const Progress& progress) {
  if (!maps_) maps_.emplace(rays_, parameters_);
  maps_->maps.fill(hits, nodes_, progress);
  maps_->cells.resize(maps_->maps.statistics().nodes, unknown_cell);
}

/// The nodes around a point, of those that it sees. Returns false where it sees none; then all.
bool SecondaryLight::find(std::uint32_t oriented_face, const glm::vec3& position,
                          BilinearWeights& bilinear) const {
  maps_->maps.find(oriented_face, position, bilinear);
  return is_open(bilinear) || maps_->visibility.keep_visible(oriented_face, position, bilinear);
}

/// Whether the middle of a cell sees all of its nodes. Threads that ask at the same time find the
/// same.
bool SecondaryLight::is_open(const BilinearWeights& cell) const {
  const std::atomic_ref<std::uint8_t> known(maps_->cells[cell.node[0]]);
  std::uint8_t state = known.load(std::memory_order_relaxed);
  if (state == unknown_cell) {
    state = maps_->visibility.is_open(cell) ? open_cell : crossed_cell;
    known.store(state, std::memory_order_relaxed);
  }
  return state == open_cell;
}

/// Finds the nodes of ray hits without a separate estimate. Those that see none of their nodes get
/// one.
void SecondaryLight::find_nodes(IndirectLight& light, std::vector<std::uint8_t>& has_own) const {
  light.nodes.resize(has_own.size());
  tbb::parallel_for(std::size_t{0}, light.rays.first.size() - 1, [&](std::size_t point) {
    const trace::FlushDenormals flush_denormals;
    for (std::size_t index = light.rays.first[point]; index < light.rays.first[point + 1];
         ++index) {
      if (has_own[index]) continue;
      const trace::EyeHit& hit = light.rays.ray_hits.hits[index];
      if (find(hit.oriented_face, hit.position, light.nodes[index])) continue;
      has_own[index] = 1;
      // Estimates of ray hits are radiance.
      light.weight[index] = hit.throughput;
    }
  });
}

/// In the order of the ends that are chosen.
SecondaryEstimates SecondaryLight::estimates_at(const trace::EyeRecord& ray_hits,
                                                std::span<const std::uint32_t> chosen,
                                                const Progress& progress) {
  trace::EyeRecord record;
  for (const std::uint32_t index : chosen) {
    record.hits.push_back(ray_hits.hits[index]);
    if (!ray_hits.glossy.empty()) record.glossy.push_back(ray_hits.glossy[index]);
  }
  std::vector<trace::HitIndex> indices;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) indices.push_back({0, i});
  PrimaryHits hits = trace::hits_at({&record, 1}, indices);
  LightTable estimates = photons_.at(hits, progress);
  return {std::move(hits), std::move(estimates)};
}

}  // namespace photile::cache
