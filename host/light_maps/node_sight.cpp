#include "light_maps/node_sight.hpp"

#include <algorithm>
#include <cmath>

#include "trace/ray_query.hpp"

namespace photile::light_maps {
namespace {

/// Lines of sight run above the surface by this part of their length: roundings and what lies flat
/// on it hide nothing.
constexpr float lift_of_length = 0x1p-9f;
/// They end so much short of the node, which may lie on the foot of a wall.
constexpr float left_out = 0x1p-5f;

struct Place {
  glm::vec3 position, normal;
};

Place place_of(const Scene& scene, std::uint32_t sided_triangle, const glm::vec3& position) {
  return {position, glm::vec3(sided_normal(scene, sided_triangle))};
}

/// Whether nothing is between two places of one surface, just above it. Where it is curved, a line
/// of sight as deep in it as a circle's chord is lifted out by twice as much.
bool see_each_other(const RayScene& rays, const Place& from, const Place& to) {
  const glm::vec3 way = to.position - from.position;
  const float turn =
      std::max(std::abs(glm::dot(way, from.normal)), std::abs(glm::dot(way, to.normal)));
  const float lift = lift_of_length * glm::length(way) + 0.5f * turn;
  const glm::vec3 start = from.position + lift * from.normal;
  const glm::vec3 end = to.position + lift * to.normal;
  return !trace::occluded(rays, start, end + left_out * (start - end));
}

}  // namespace

bool NodeSight::look(std::uint32_t sided_triangle, const glm::vec3& position,
                     NodeBlend& blend) const {
  if (!maps_.uneven(blend, contrast_)) return true;
  const Scene& scene = rays_.scene();
  const Place here = place_of(scene, sided_triangle, position);
  NodeBlend seen = blend;
  float sum = 0;
  for (std::size_t i = 0; i < seen.node.size(); ++i) {
    if (seen.weight[i] == 0.0f) continue;
    const LightMaps::NodePoint& node = maps_.point(seen.node[i]);
    if (see_each_other(rays_, here, place_of(scene, node.sided_triangle, node.position))) {
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

bool NodeSight::sees(std::uint32_t sided_triangle, const glm::vec3& from,
                     const glm::vec3& to) const {
  const Scene& scene = rays_.scene();
  return see_each_other(rays_, place_of(scene, sided_triangle, from),
                        place_of(scene, sided_triangle, to));
}

}  // namespace photile::light_maps
