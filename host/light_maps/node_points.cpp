#include "light_maps/node_points.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "trace/surface.hpp"

namespace photile::light_maps {

PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                        int levels, bool glossy) {
  std::vector<std::uint32_t> used;
  for (const NodePlace& node : nodes) used.push_back(node.chart);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  tbb::parallel_for(std::size_t{0}, used.size(), [&](std::size_t i) { charts.prepare(used[i]); });

  PrimaryHits points;
  points.position.resize(nodes.size());
  points.sided_triangle.resize(nodes.size());
  points.pixel.resize(nodes.size());
  points.throughput.assign(nodes.size(), glm::vec3(1.0f));
  points.diffuse_albedo.assign(nodes.size(), glm::vec3(0.0f));
  if (glossy) {
    points.outgoing.resize(nodes.size());
    points.lobe.resize(nodes.size());
  }
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    const Charts::Owner owner = charts.owner(nodes[i], levels);
    const trace::SurfacePoint point = trace::surface_point(scene, owner.where, owner.side);
    points.position[i] = point.position;
    points.sided_triangle[i] = point.sided_triangle();
    if (!glossy) return;
    points.outgoing[i] = point.normal;
    points.lobe[i] = {.specular = glm::vec3(0.0f),
                      .roughness = 0.0f,
                      .normal = point.normal,
                      .smooth_normal = point.normal};
  });
  return points;
}

}  // namespace photile::light_maps
