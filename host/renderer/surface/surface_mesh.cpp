#include "surface/surface_mesh.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <tuple>

#include "geometry/radix_sort.hpp"
#include "geometry/welded_vertices.hpp"

namespace photile::surface {
namespace {

struct SortedCorners {
  std::array<std::uint32_t, 3> corner;
  bool odd;     ///< sorting them turned the triangle over
  bool stores;  ///< SurfaceMesh::stores
  std::uint32_t triangle;
};

SortedCorners sorted(std::array<std::uint32_t, 3> corner, bool stores, std::uint32_t triangle) {
  bool odd = false;
  const auto order = [&](int i, int j) {
    if (corner[i] <= corner[j]) return;
    std::swap(corner[i], corner[j]);
    odd = !odd;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {corner, odd, stores, triangle};
}

std::vector<std::uint32_t> originals(const SurfaceMesh& mesh) {
  std::vector<SortedCorners> triangles;
  std::vector<std::uint32_t> original(2 * mesh.corner.size());
  for (std::uint32_t t = 0; t < mesh.corner.size(); ++t) {
    triangles.push_back(sorted(mesh.corner[t], mesh.stores(t), t));
  }
  tbb::parallel_sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) {
    return std::tie(a.corner, a.stores, a.triangle) < std::tie(b.corner, b.stores, b.triangle);
  });
  std::size_t first = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (triangles[i].corner != triangles[first].corner ||
        triangles[i].stores != triangles[first].stores) {
      first = i;
    }
    const std::uint32_t flip = triangles[i].odd != triangles[first].odd ? 1 : 0;
    for (const std::uint32_t side : {0u, 1u}) {
      original[oriented(triangles[i].triangle, side)] =
          oriented(triangles[first].triangle, side ^ flip);
    }
  }
  return original;
}

}  // namespace

SurfaceMesh::SurfaceMesh(const Scene& from)
    : scene(from), corner(from.triangle_count()), normal(from.triangle_count()) {
  const std::vector<std::uint32_t> welded = geometry::welded_vertices(from.vertices);
  tbb::parallel_for(std::size_t{0}, corner.size(), [&](std::size_t t) {
    const glm::uvec3& vertices = scene.triangles[t];
    corner[t] = {welded[vertices.x], welded[vertices.y], welded[vertices.z]};
    normal[t] = face_normal(scene, oriented(static_cast<std::uint32_t>(t), 0));
  });
  original = originals(*this);
  for (std::uint32_t t = 0; t < corner.size(); ++t) {
    if (!counts(t)) continue;
    for (std::uint8_t i = 0; i < 3; ++i) {
      const std::uint32_t from_corner = corner[t][i], to_corner = corner[t][(i + 1) % 3];
      edges.push_back({std::min(from_corner, to_corner), std::max(from_corner, to_corner), t, i,
                       from_corner < to_corner});
    }
  }
  // Edges of equal corners are in the order of their triangles, and stay so.
  const int bits = std::bit_width(scene.vertices.size());
  geometry::radix_sort(edges, 2 * bits, [bits](const MeshEdge& edge) {
    return std::uint64_t{edge.low} << bits | edge.high;
  });
}

}  // namespace photile::surface
