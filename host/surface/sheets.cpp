#include "surface/sheets.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/box_tree.hpp"
#include "photile/neighbour_groups.hpp"
#include "surface/disjoint_sets.hpp"

namespace photile::surface {
namespace {

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

/// The parts of several tasks, one after the other.
template <class Value>
void append_all(const std::vector<std::vector<Value>>& parts, std::vector<Value>& all) {
  for (const std::vector<Value>& part : parts) all.insert(all.end(), part.begin(), part.end());
}

void join_along_edges(const SurfaceMesh& mesh, const std::vector<LoneEdge>& edges, double tolerance,
                      double cos_angle, std::vector<Connection>& connections) {
  constexpr std::size_t edges_per_task = 1024;
  std::vector<geometry::Box> boxes(edges.size());
  std::transform(edges.begin(), edges.end(), boxes.begin(), box_of);
  const geometry::BoxTree tree(boxes);
  const auto limit = static_cast<float>(tolerance * tolerance);
  const auto join = [&](std::size_t i, std::vector<Connection>& found) {
    tree.visit_within(boxes[i], limit, [&](std::uint32_t j) {
      if (j <= i || !run_along(edges[i], edges[j], tolerance)) return false;
      const double directions = glm::dot(edges[i].to - edges[i].from, edges[j].to - edges[j].from);
      const std::uint32_t a = edges[i].triangle, b = edges[j].triangle;
      const std::uint32_t flip = directions > 0 ? 1 : 0;
      const glm::dvec3 other = flip == 0 ? mesh.normal[b] : -mesh.normal[b];
      if (mesh.stores(a) != mesh.stores(b)) return false;
      if (normals_agree(mesh.normal[a], other, cos_angle)) found.push_back({a, b, flip});
      return false;
    });
  };
  std::vector<std::vector<Connection>> found((edges.size() + edges_per_task - 1) / edges_per_task);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t task) {
    const std::size_t last = std::min(edges.size(), (task + 1) * edges_per_task);
    for (std::size_t i = task * edges_per_task; i < last; ++i) join(i, found[task]);
  });
  append_all(found, connections);
}

}  // namespace

std::vector<Connection> find_connections(const SurfaceMesh& mesh, double radius,
                                         double angle_degrees) {
  const double cos_angle = std::cos(glm::radians(angle_degrees));
  std::vector<std::vector<Connection>> connected(mesh.edge_shares());
  std::vector<std::vector<LoneEdge>> alone(mesh.edge_shares());
  tbb::parallel_for(std::size_t{0}, mesh.edge_shares(), [&](std::size_t share) {
    mesh.for_each_edge_of(share, [&](std::span<const MeshEdge> edges) {
      if (edges.size() == 1) {
        const MeshEdge& edge = edges.front();
        const auto corners = mesh.scene.corners(edge.triangle);
        alone[share].push_back({corners[edge.index], corners[(edge.index + 1) % 3], edge.triangle});
      }
      for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
          if (!(fold_cosine(mesh, edges[i], edges[j]) >= cos_angle - 1e-6)) continue;
          connected[share].push_back(
              {edges[i].triangle, edges[j].triangle, flip_between(edges[i], edges[j])});
        }
      }
    });
  });
  std::vector<Connection> connections;
  std::vector<LoneEdge> lone;
  append_all(connected, connections);
  append_all(alone, lone);
  join_along_edges(mesh, lone, 1e-3 * radius, cos_angle, connections);
  return connections;
}

Sheets join_sheets(const SurfaceMesh& mesh, std::span<const Connection> connections,
                   std::span<const std::uint8_t> dark) {
  DisjointSets joined(mesh.original.size());
  for_each_pair_of_sides(connections, [&](std::uint32_t a, std::uint32_t b) {
    if (dark.empty() || dark[a] == dark[b]) joined.join(a, b);
  });
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

Sheets find_sheets(const SurfaceMesh& mesh, double radius, double angle_degrees) {
  return join_sheets(mesh, find_connections(mesh, radius, angle_degrees));
}

}  // namespace photile::surface
