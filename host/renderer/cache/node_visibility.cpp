#include "cache/node_visibility.hpp"

#include <algorithm>

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

bool NodeVisibility::is_in_slit(const SurfaceLocation& here, const SurfaceLocation& there,
                                float reach) const {
  return is_covered(rays_, there, here.position, reach) &&
         !is_covered(rays_, here, there.position, reach);
}

/// Whether the node lies in a slit, such as the gap behind a door.
bool NodeVisibility::is_in_slit(const SurfaceLocation& here, std::uint32_t node) const {
  const LightMaps::NodePoint& point = maps_.point(node);
  const float apart = glm::distance(here.position, point.position);
  return maps_.distance(node) < apart &&
         is_in_slit(here, location_on(rays_.scene(), point.oriented_face, point.position), apart);
}

bool NodeVisibility::keep_visible(std::uint32_t oriented_face, const glm::vec3& position,
                                  BilinearWeights& bilinear) const {
  if (!maps_.uneven(bilinear, contrast_)) return true;
  const Scene& scene = rays_.scene();
  const SurfaceLocation here = location_on(scene, oriented_face, position);
  BilinearWeights seen = bilinear;
  float sum = 0;
  for (std::size_t i = 0; i < seen.node.size(); ++i) {
    if (seen.weight[i] == 0.0f) continue;
    const LightMaps::NodePoint& node = maps_.point(seen.node[i]);
    if (cache::sees(rays_, here, location_on(scene, node.oriented_face, node.position)) &&
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

bool NodeVisibility::is_open(const BilinearWeights& cell) const {
  const Scene& scene = rays_.scene();
  glm::vec3 middle(0.0f);
  for (const std::uint32_t node : cell.node) middle += 0.25f * maps_.point(node).position;
  const SurfaceLocation here = location_on(scene, maps_.point(cell.node[0]).oriented_face, middle);
  return std::all_of(cell.node.begin(), cell.node.end(), [&](std::uint32_t index) {
    const LightMaps::NodePoint& node = maps_.point(index);
    return cache::sees(rays_, here, location_on(scene, node.oriented_face, node.position));
  });
}

bool NodeVisibility::sees(std::uint32_t oriented_face, const glm::vec3& from,
                          const glm::vec3& to) const {
  const Scene& scene = rays_.scene();
  return cache::sees(rays_, location_on(scene, oriented_face, from),
                     location_on(scene, oriented_face, to));
}

}  // namespace photile::cache
