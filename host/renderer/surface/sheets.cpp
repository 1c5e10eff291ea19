#include "surface/sheets.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "photile/neighbour_groups.hpp"
#include "surface/boundary_edges.hpp"

namespace photile::surface {

namespace {

/// The parts of several tasks, one after the other.
template <class Value>
void append_all(const std::vector<std::vector<Value>>& parts, std::vector<Value>& all) {
  for (const std::vector<Value>& part : parts) all.insert(all.end(), part.begin(), part.end());
}

void join_along_edges(const SurfaceMesh& mesh, const BoundaryEdges& edges, double cos_angle,
                      std::vector<Connection>& connections) {
  constexpr std::size_t edges_per_task = 1024;
  std::vector<std::vector<Connection>> found((edges.size() + edges_per_task - 1) / edges_per_task);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t task) {
    const auto connect = [&](const BoundaryEdge& edge, const BoundaryEdge& other) {
      const std::uint32_t a = edge.triangle, b = other.triangle;
      if (mesh.stores(a) != mesh.stores(b)) return;
      const std::uint32_t flip = glm::dot(edge.to - edge.from, other.to - other.from) > 0 ? 1 : 0;
      const glm::dvec3 normal = flip == 0 ? mesh.normal[b] : -mesh.normal[b];
      if (normals_agree(mesh.normal[a], normal, cos_angle)) found[task].push_back({a, b, flip});
    };
    const std::size_t last = std::min(edges.size(), (task + 1) * edges_per_task);
    for (std::size_t i = task * edges_per_task; i < last; ++i)
      edges.visit_along(static_cast<std::uint32_t>(i), connect);
  });
  append_all(found, connections);
}

}  // namespace

std::vector<Connection> find_connections(const SurfaceMesh& mesh, double radius,
                                         double angle_degrees) {
  const double cos_angle = std::cos(glm::radians(angle_degrees));
  std::vector<std::vector<Connection>> connected(mesh.edge_shares());
  std::vector<std::vector<BoundaryEdge>> alone(mesh.edge_shares());
  tbb::parallel_for(std::size_t{0}, mesh.edge_shares(), [&](std::size_t share) {
    mesh.for_each_edge_of(share, [&](std::span<const MeshEdge> edges) {
      if (edges.size() == 1) {
        const MeshEdge& edge = edges.front();
        const auto corners = mesh.scene.corners(edge.triangle);
        alone[share].push_back({corners[edge.index], corners[(edge.index + 1) % 3], edge.triangle});
      }
      for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
          if (!(fold_cosine(mesh, edges[i], edges[j]) >= cos_angle - cosine_slack)) continue;
          connected[share].push_back(
              {edges[i].triangle, edges[j].triangle, flip_between(edges[i], edges[j])});
        }
      }
    });
  });
  std::vector<Connection> connections;
  std::vector<BoundaryEdge> lone;
  append_all(connected, connections);
  append_all(alone, lone);
  join_along_edges(mesh, BoundaryEdges(std::move(lone), 1e-3 * radius), cos_angle, connections);
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
