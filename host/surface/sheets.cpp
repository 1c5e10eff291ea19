#include "surface/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/box_tree.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::surface {
namespace {

/// Disjoint sets of sided triangles; the smallest of a set stands for it.
class SheetUnion {
 public:
  explicit SheetUnion(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void join_sides(SheetUnion& sheets, std::uint32_t a, std::uint32_t b, std::uint32_t flip) {
  for (const std::uint32_t side : {0u, 1u}) sheets.join(sided(a, side), sided(b, side ^ flip));
}

/// An edge that no other has both corners of.
struct LoneEdge {
  glm::dvec3 from, to;
  std::uint32_t triangle;
};

geometry::Box box_of(const LoneEdge& edge) {
  geometry::Box box;
  box.extend(glm::vec3(edge.from));
  box.extend(glm::vec3(edge.to));
  return box;
}

/// Whether the edges lie on one line, within `tolerance`, and share more of it than that.
bool run_along(const LoneEdge& a, const LoneEdge& b, double tolerance) {
  const glm::dvec3 along = glm::normalize(a.to - a.from);
  const auto offset = [&](const glm::dvec3& p) {
    const glm::dvec3 d = p - a.from;
    return glm::length(d - along * glm::dot(d, along));
  };
  if (!(offset(b.from) <= tolerance) || !(offset(b.to) <= tolerance)) return false;
  const double first = glm::dot(b.from - a.from, along), last = glm::dot(b.to - a.from, along);
  const double shared = std::min(std::max(first, last), glm::length(a.to - a.from)) -
                        std::max(std::min(first, last), 0.0);
  return shared > 2 * tolerance;
}

void join_along_edges(const SurfaceMesh& mesh, const std::vector<LoneEdge>& edges, double tolerance,
                      double cos_angle, SheetUnion& sheets) {
  std::vector<geometry::Box> boxes;
  for (const LoneEdge& edge : edges) boxes.push_back(box_of(edge));
  const geometry::BoxTree tree(boxes);
  const auto limit = static_cast<float>(tolerance * tolerance);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    tree.visit_within(boxes[i], limit, [&](std::uint32_t j) {
      if (j <= i || !run_along(edges[i], edges[j], tolerance)) return false;
      const double directions = glm::dot(edges[i].to - edges[i].from, edges[j].to - edges[j].from);
      const std::uint32_t a = edges[i].triangle, b = edges[j].triangle;
      const std::uint32_t flip = directions > 0 ? 1 : 0;
      const glm::dvec3 other = flip == 0 ? mesh.normal[b] : -mesh.normal[b];
      if (mesh.stores(a) != mesh.stores(b)) return false;
      if (normals_agree(mesh.normal[a], other, cos_angle)) join_sides(sheets, a, b, flip);
      return false;
    });
  }
}

}  // namespace

Sheets find_sheets(const SurfaceMesh& mesh, double radius, double angle_degrees) {
  const double cos_angle = std::cos(glm::radians(angle_degrees));
  SheetUnion joined(mesh.original.size());
  std::vector<LoneEdge> lone;
  mesh.for_each_edge([&](std::span<const MeshEdge> edges) {
    if (edges.size() == 1) {
      const MeshEdge& edge = edges.front();
      const auto corners = mesh.scene.corners(edge.triangle);
      lone.push_back({corners[edge.index], corners[(edge.index + 1) % 3], edge.triangle});
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        if (!(fold_cosine(mesh, edges[i], edges[j]) >= cos_angle - 1e-6)) continue;
        join_sides(joined, edges[i].triangle, edges[j].triangle, flip_between(edges[i], edges[j]));
      }
    }
  });
  join_along_edges(mesh, lone, 1e-3 * radius, cos_angle, joined);

  Sheets sheets;
  sheets.of.assign(mesh.original.size(), none);
  for (std::uint32_t s = 0; s < mesh.original.size(); ++s) {
    const std::uint32_t first = joined.find(mesh.original[s]);
    if (first == s) {
      sheets.of[s] = sheets.count++;
    } else {
      sheets.of[s] = sheets.of[first];
    }
  }
  return sheets;
}

}  // namespace photile::surface
