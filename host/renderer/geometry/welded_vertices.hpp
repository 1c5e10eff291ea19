// Vertices that lie at one position.
#pragma once

#include <tbb/parallel_sort.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <tuple>
#include <vector>

namespace photile::geometry {

/// Per vertex the smallest index of those at the same position. Scenes of load_scene and
/// SceneBuilder have one vertex at each position; those that are filled by hand may have several.
inline std::vector<std::uint32_t> welded_vertices(const std::vector<glm::vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const glm::vec3 &p = vertices[a], &q = vertices[b];
    return std::tuple(p.x, p.y, p.z, a) < std::tuple(q.x, q.y, q.z, b);
  });
  std::vector<std::uint32_t> welded(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

}  // namespace photile::geometry
