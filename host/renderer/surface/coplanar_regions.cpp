#include "surface/coplanar_regions.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/touched_memory.hpp"
#include "photile/device/surface.h"

namespace photile::surface {

namespace {

/// Two triangles of a region differ from each other by twice the angle: a cosine of 1 - 8e-7.
constexpr double least_cosine = 1 - 2e-7;
constexpr double largest_height = 1e-3;  ///< over the radius

/// What lies beyond each edge of a triangle: the triangle that continues it, none where there is no
/// other or where it is not clear which.
using Beyond = std::array<std::uint32_t, 3>;

/// With more triangles at an edge it is not clear which of them continues another.
constexpr std::size_t most_triangles_of_edge = 64;

/// The one edge that continues the plane of `edge`, if there is just one, seen from either side.
const MeshEdge* continuation(const SurfaceMesh& mesh, std::span<const MeshEdge> edges,
                             const MeshEdge& edge) {
  const MeshEdge* found = nullptr;
  for (const MeshEdge& other : edges) {
    if (&other == &edge || !(fold_cosine(mesh, edge, other) >= least_cosine)) continue;
    if (found != nullptr) return nullptr;
    found = &other;
  }
  return found;
}

bool equally_dark(std::span<const std::uint8_t> dark, const MeshEdge& a, const MeshEdge& b) {
  if (dark.empty()) return true;
  const std::uint32_t flip = flip_between(a, b);
  return dark[oriented(a.triangle, 0)] == dark[oriented(b.triangle, flip)] &&
         dark[oriented(a.triangle, 1)] == dark[oriented(b.triangle, 1 ^ flip)];
}

std::vector<Beyond> triangles_beyond(const SurfaceMesh& mesh, std::span<const std::uint8_t> dark) {
  std::vector<Beyond> beyond(mesh.normal.size(), Beyond{none, none, none});
  tbb::parallel_for(std::size_t{0}, mesh.edge_chunks(), [&](std::size_t chunk) {
    mesh.for_each_edge_of(chunk, [&](std::span<const MeshEdge> edges) {
      if (edges.size() > most_triangles_of_edge) return;
      for (const MeshEdge& edge : edges) {
        const MeshEdge* next = continuation(mesh, edges, edge);
        if (next == nullptr || continuation(mesh, edges, *next) != &edge) continue;
        if (!equally_dark(dark, edge, *next)) continue;
        beyond[edge.triangle][edge.index] = next->triangle;
      }
    });
  });
  return beyond;
}

class RegionGrower {
 public:
  RegionGrower(const SurfaceMesh& mesh, const std::vector<Beyond>& beyond, double radius,
               std::vector<std::uint32_t>& plane)
      : mesh_(mesh), beyond_(beyond), height_(largest_height * radius), plane_(plane) {}

  /// The triangles of all regions, each region's together, its seed first.
  const std::vector<std::uint32_t>& members() const { return members_; }

  void grow(std::uint32_t seed) {
    std::size_t i = members_.size();
    members_.push_back(seed);
    plane_[seed] = seed;
    normal_ = mesh_.normal[seed];
    point_ = glm::dvec3(mesh_.scene.corners(seed)[0]);
    for (; i < members_.size(); ++i) {
      for (const std::uint32_t next : beyond_[members_[i]]) {
        if (next == none || plane_[next] != none || !in_plane(next)) continue;
        plane_[next] = seed;
        members_.push_back(next);
      }
    }
  }

 private:
  bool in_plane(std::uint32_t triangle) const {
    if (!(std::abs(glm::dot(mesh_.normal[triangle], normal_)) >= least_cosine)) return false;
    for (const glm::vec3& corner : mesh_.scene.corners(triangle)) {
      if (!(std::abs(glm::dot(glm::dvec3(corner) - point_, normal_)) <= height_)) return false;
    }
    return true;
  }

  const SurfaceMesh& mesh_;
  const std::vector<Beyond>& beyond_;
  double height_;
  std::vector<std::uint32_t>& plane_;
  std::vector<std::uint32_t> members_;
  glm::dvec3 normal_{0.0}, point_{0.0};
};

double diagonal_of(const Scene& scene, std::span<const std::uint32_t> triangles) {
  geometry::Box box;
  for (const std::uint32_t triangle : triangles) {
    box.extend(geometry::triangle_box(scene, triangle));
  }
  return glm::distance(glm::dvec3(box.lower), glm::dvec3(box.upper));
}

void add_borders(const SurfaceMesh& mesh, const std::vector<Beyond>& beyond, std::uint32_t triangle,
                 const std::vector<std::uint32_t>& plane, std::vector<BorderEdge>& borders) {
  const auto corners = mesh.scene.corners(triangle);
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t next = beyond[triangle][i];
    if (next != none && plane[next] == plane[triangle]) continue;
    const glm::dvec3 from(corners[i]), to(corners[(i + 1) % 3]);
    borders.push_back({corners[i], corners[(i + 1) % 3],
                       glm::vec3(glm::normalize(glm::cross(mesh.normal[triangle], to - from))),
                       triangle});
  }
}

}  // namespace

CoplanarRegions find_coplanar_regions(const SurfaceMesh& mesh, double radius,
                                      std::span<const std::uint8_t> dark) {
  const std::size_t count = mesh.normal.size();
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (mesh.counts(t)) seeds.push_back(t);
  }
  std::vector<double> area(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
    area[t] = triangle_area(mesh.scene, static_cast<std::uint32_t>(t));
  });
  tbb::parallel_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
    return area[a] != area[b] ? area[a] > area[b] : a < b;
  });
  const std::vector<Beyond> beyond = triangles_beyond(mesh, dark);
  CoplanarRegions regions;
  regions.of_triangle.assign(count, PHOTILE_NO_REGION);
  regions.plane.assign(count, none);
  RegionGrower grower(mesh, beyond, radius, regions.plane);
  std::vector<std::size_t> first_of;
  for (const std::uint32_t seed : seeds) {
    if (regions.plane[seed] != none) continue;
    first_of.push_back(grower.members().size());
    grower.grow(seed);
  }
  first_of.push_back(grower.members().size());
  std::vector<std::vector<BorderEdge>> borders(first_of.size() - 1);
  tbb::parallel_for(std::size_t{0}, borders.size(), [&](std::size_t i) {
    const std::span members(grower.members().data() + first_of[i], first_of[i + 1] - first_of[i]);
    std::vector<BorderEdge> own;
    for (const std::uint32_t t : members) add_borders(mesh, beyond, t, regions.plane, own);
    const bool small = diagonal_of(mesh.scene, members) <= 2 * radius;
    if (small && members.size() <= 2 * own.size()) return;
    for (const std::uint32_t t : members) regions.of_triangle[t] = members.front();
    borders[i] = std::move(own);
  });
  regions.borders = joined(
      borders.size(), [&](std::size_t i) -> const auto& { return borders[i]; });
  return regions;
}

PlaneTree::PlaneTree(const SurfaceMesh& mesh, const CoplanarRegions& regions)
    : mesh_(mesh), regions_(regions), tree_(geometry::triangle_boxes(mesh.scene)) {
  plane_ = tree_.folded(
      nothing, [&](std::uint32_t t) { return mesh.counts(t) ? regions.plane[t] : nothing; },
      [](std::uint32_t a, std::uint32_t b) {
        if (a == nothing || a == b) return b;
        return b == nothing ? a : several;
      });
}

}  // namespace photile::surface
