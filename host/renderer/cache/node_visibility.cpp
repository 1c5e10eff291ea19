// Which of the nodes around a point of the surface give the light that falls there.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "cache/light_maps.hpp"
#include "trace/ray_query.hpp"

namespace photile::cache {

using trace::location_on;
using trace::SurfaceLocation;

bool sees(const RayScene& rays, const SurfaceLocation& from, const SurfaceLocation& to) {
  if (from.position == to.position) return true;
  return trace::see_each_other(
      rays, from, to,
      {defaults::visibility_ray_offset * glm::distance(from.position, to.position),
       defaults::visibility_left_out});
}

namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t points_per_task_of_nodes = 1024;

/// Whether something lies in front of a location, nearer than this. The edge that it may lie on is
/// left out by a step to a point of the surface.
bool is_covered(const RayScene& rays, const SurfaceLocation& location, const glm::vec3& beside,
                float reach) {
  const glm::vec3 foot =
      location.position + defaults::visibility_left_out * (beside - location.position);
  return trace::occluded(rays, foot + defaults::visibility_ray_offset * reach * location.normal,
                         foot + reach * location.normal);
}

}  // namespace

bool LightMaps::is_in_slit(const SurfaceLocation& here, const SurfaceLocation& there,
                           float reach) const {
  return is_covered(rays_, there, here.position, reach) &&
         !is_covered(rays_, here, there.position, reach);
}

/// Whether the node lies in a slit, such as the gap behind a door.
bool LightMaps::is_in_slit(const SurfaceLocation& here, std::uint32_t node) const {
  const NodePoint& there = point(node);
  const float apart = glm::distance(here.position, there.position);
  return distance(node) < apart &&
         is_in_slit(here, location_on(scene_, there.oriented_face, there.position), apart);
}

bool LightMaps::keep_visible(std::uint32_t oriented_face, const glm::vec3& position,
                             BilinearWeights& bilinear) const {
  if (visibility_ == Visibility::of_cells && is_open(bilinear)) return true;
  if (!uneven(bilinear)) return true;
  const SurfaceLocation here = location_on(scene_, oriented_face, position);
  BilinearWeights seen = bilinear;
  float sum = 0;
  for (std::size_t i = 0; i < seen.node.size(); ++i) {
    if (seen.weight[i] == 0.0f) continue;
    const NodePoint& node = point(seen.node[i]);
    if (cache::sees(rays_, here, location_on(scene_, node.oriented_face, node.position)) &&
        !is_in_slit(here, seen.node[i])) {
      sum += seen.weight[i];
    } else {
      seen.weight[i] = 0.0f;
    }
  }
  if (!(sum > 0.0f)) return false;
  for (float& weight : seen.weight) weight /= sum;
  bilinear = seen;
  return true;
}

/// Whether the middle of a cell sees all of its nodes. Threads that ask at the same time find the
/// same.
bool LightMaps::is_open(const BilinearWeights& cell) const {
  const std::atomic_ref<std::uint8_t> known(seen_by_middle_[cell.node[0]]);
  const std::uint8_t state = known.load(std::memory_order_relaxed);
  if (state != unknown) return state == all_nodes;
  glm::vec3 middle(0.0f);
  for (const std::uint32_t node : cell.node) middle += 0.25f * point(node).position;
  const SurfaceLocation here = location_on(scene_, point(cell.node[0]).oriented_face, middle);
  const bool sees_all = std::all_of(cell.node.begin(), cell.node.end(), [&](std::uint32_t node) {
    return cache::sees(rays_, here,
                       location_on(scene_, point(node).oriented_face, point(node).position));
  });
  known.store(sees_all ? all_nodes : not_all, std::memory_order_relaxed);
  return sees_all;
}

LightMaps::Around LightMaps::around(const PrimaryHits& points, const Progress& progress,
                                    int levels) {
  fill(points, progress, all_rounds, levels);
  Around around{std::vector<BilinearWeights>(points.size()),
                std::vector<std::uint8_t>(points.size())};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), points_per_task_of_nodes),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const trace::FlushDenormals flush_denormals;
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const std::uint32_t face = points.oriented_face[i];
                        const glm::vec3& position = points.position[i];
                        find(face, position, around.nodes[i], levels);
                        around.seen[i] = keep_visible(face, position, around.nodes[i]);
                      }
                    });
  return around;
}

bool LightMaps::sees(std::uint32_t oriented_face, const glm::vec3& from,
                     const glm::vec3& to) const {
  return cache::sees(rays_, location_on(scene_, oriented_face, from),
                     location_on(scene_, oriented_face, to));
}

}  // namespace photile::cache
