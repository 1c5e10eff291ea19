#include "cache/node_visibility.hpp"

#include <algorithm>

#include "trace/ray_query.hpp"

namespace photile::cache {
namespace {

using trace::place_on;
using trace::SurfacePlace;

bool see_each_other(const RayScene& rays, const SurfacePlace& from, const SurfacePlace& to) {
  return trace::see_each_other(rays, from, to,
                               {defaults::sight_lift * glm::distance(from.position, to.position),
                                defaults::visibility_left_out});
}

/// Whether something lies in front of a place, nearer than this. The edge that it may lie on is
/// left out by a step to a point of the surface.
bool is_covered(const RayScene& rays, const SurfacePlace& place, const glm::vec3& beside,
                float reach) {
  const glm::vec3 foot = place.position + defaults::visibility_left_out * (beside - place.position);
  return trace::occluded(rays, foot + defaults::sight_lift * reach * place.normal,
                         foot + reach * place.normal);
}

}  // namespace

bool NodeVisibility::is_in_slit(const SurfacePlace& here, const SurfacePlace& there,
                                float reach) const {
  return is_covered(rays_, there, here.position, reach) &&
         !is_covered(rays_, here, there.position, reach);
}

/// Such as the gap behind a door.
bool NodeVisibility::is_in_slit(const SurfacePlace& here, std::uint32_t node) const {
  const LightMaps::NodePoint& point = maps_.point(node);
  const float apart = glm::distance(here.position, point.position);
  return maps_.distance(node) < apart &&
         is_in_slit(here, place_on(rays_.scene(), point.oriented_face, point.position), apart);
}

bool NodeVisibility::look(std::uint32_t oriented_face, const glm::vec3& position,
                          NodeBlend& blend) const {
  if (!maps_.uneven(blend, contrast_)) return true;
  const Scene& scene = rays_.scene();
  const SurfacePlace here = place_on(scene, oriented_face, position);
  NodeBlend seen = blend;
  float sum = 0;
  for (std::size_t i = 0; i < seen.node.size(); ++i) {
    if (seen.weight[i] == 0.0f) continue;
    const LightMaps::NodePoint& node = maps_.point(seen.node[i]);
    if (see_each_other(rays_, here, place_on(scene, node.oriented_face, node.position)) &&
        !is_in_slit(here, seen.node[i])) {
      sum += seen.weight[i];
    } else {
      seen.weight[i] = 0.0f;
    }
  }
  if (!(sum > 0.0f)) return false;
  for (float& weight : seen.weight) weight /= sum;
  blend = seen;
  return true;
}

bool NodeVisibility::is_open(const NodeBlend& cell) const {
  const Scene& scene = rays_.scene();
  glm::vec3 middle(0.0f);
  for (const std::uint32_t node : cell.node) middle += 0.25f * maps_.point(node).position;
  const SurfacePlace here = place_on(scene, maps_.point(cell.node[0]).oriented_face, middle);
  return std::all_of(cell.node.begin(), cell.node.end(), [&](std::uint32_t index) {
    const LightMaps::NodePoint& node = maps_.point(index);
    return see_each_other(rays_, here, place_on(scene, node.oriented_face, node.position));
  });
}

bool NodeVisibility::sees(std::uint32_t oriented_face, const glm::vec3& from,
                          const glm::vec3& to) const {
  const Scene& scene = rays_.scene();
  return see_each_other(rays_, place_on(scene, oriented_face, from),
                        place_on(scene, oriented_face, to));
}

}  // namespace photile::cache
