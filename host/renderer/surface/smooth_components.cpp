#include "surface/smooth_components.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/touched_memory.hpp"
#include "geometry/disjoint_sets.hpp"
#include "photile/neighbour_groups.hpp"
#include "surface/boundary_edges.hpp"

namespace photile::surface {

namespace {

void join_along_edges(const SurfaceMesh& mesh, const BoundaryEdges& edges, double cos_angle,
                      std::vector<std::vector<Connection>>& connected) {
  constexpr std::size_t edges_per_task = 1024;
  const std::size_t tasks = (edges.size() + edges_per_task - 1) / edges_per_task;
  connected.resize(connected.size() + tasks);
  const std::span found = std::span(connected).last(tasks);
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    const auto connect = [&](const BoundaryEdge& edge, const BoundaryEdge& other) {
      const std::uint32_t a = edge.triangle, b = other.triangle;
      if (mesh.stores(a) != mesh.stores(b)) return;
      const std::uint32_t flip = glm::dot(edge.to - edge.from, other.to - other.from) > 0 ? 1 : 0;
      const glm::dvec3 normal = flip == 0 ? mesh.normal[b] : -mesh.normal[b];
      if (normals_agree(mesh.normal[a], normal, cos_angle))
        found[task].push_back({a, b, flip, false});
    };
    const std::size_t last = std::min(edges.size(), (task + 1) * edges_per_task);
    for (std::size_t i = task * edges_per_task; i < last; ++i)
      edges.visit_along(static_cast<std::uint32_t>(i), connect);
  });
}

/// Edges that more triangles share are those of fans: not all pairs are looked at.
constexpr std::size_t most_triangles_in_pairs = 64;

/// Of the triangles round an edge, those that may continue each other with the least folds, each
/// with some on either side: where all that do are joined, so are all that these join.
template <class Visit>
void for_each_likely_pair(const SurfaceMesh& mesh, std::span<const MeshEdge> edges,
                          const Visit& visit) {
  constexpr std::size_t on_either_side = 4;
  const MeshEdge& first = edges.front();
  const auto corners = mesh.scene.corners(first.triangle);
  const glm::dvec3 axis =
      glm::normalize(glm::dvec3(corners[(first.index + 1) % 3]) - glm::dvec3(corners[first.index]));
  const glm::dvec3 across =
      glm::cross(axis, std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  const glm::dvec3 along = glm::cross(axis, across);
  struct Turned {
    double turn;  ///< radians round the edge, of the normal that looks to one side of it
    const MeshEdge* edge;
  };
  for (const bool stores : {false, true}) {  // others do not continue each other
    std::vector<Turned> all;
    for (const MeshEdge& edge : edges) {
      if (mesh.stores(edge.triangle) != stores) continue;
      const glm::dvec3& normal = mesh.normal[edge.triangle];
      const double turn = std::atan2(glm::dot(normal, along), glm::dot(normal, across));
      const double towards = edge.forward ? turn : turn + glm::pi<double>();
      all.push_back(
          {std::isfinite(turn) ? std::remainder(towards, glm::two_pi<double>()) : 0.0, &edge});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Turned& a, const Turned& b) { return a.turn < b.turn; });
    for (const Turned& own : all) {
      const double opposite = std::remainder(own.turn + glm::pi<double>(), glm::two_pi<double>());
      const auto above =
          std::lower_bound(all.begin(), all.end(), opposite,
                           [](const Turned& a, double turn) { return a.turn < turn; });
      const std::size_t middle =
          static_cast<std::size_t>(above - all.begin()) + on_either_side * all.size();
      for (std::size_t i = middle - on_either_side; i < middle + on_either_side; ++i) {
        const MeshEdge* const other = all[i % all.size()].edge;
        if (other != own.edge) visit(*own.edge, *other);
      }
    }
  }
}

}  // namespace

std::vector<Connection> find_connections(const SurfaceMesh& mesh, double radius,
                                         double angle_degrees) {
  const double cos_angle = std::cos(glm::radians(angle_degrees));
  std::vector<std::vector<Connection>> connected(mesh.edge_chunks());
  std::vector<std::vector<BoundaryEdge>> alone(mesh.edge_chunks());
  tbb::parallel_for(std::size_t{0}, mesh.edge_chunks(), [&](std::size_t chunk) {
    mesh.for_each_edge_of(chunk, [&](std::span<const MeshEdge> edges) {
      if (edges.size() == 1) {
        const MeshEdge& edge = edges.front();
        const auto corners = mesh.scene.corners(edge.triangle);
        alone[chunk].push_back({corners[edge.index], corners[(edge.index + 1) % 3], edge.triangle});
      }
      const auto connect = [&](const MeshEdge& a, const MeshEdge& b) {
        if (!(fold_cosine(mesh, a, b) >= cos_angle - cosine_slack)) return;
        connected[chunk].push_back({a.triangle, b.triangle, flip_between(a, b), true});
      };
      if (edges.size() > most_triangles_in_pairs) {
        for_each_likely_pair(mesh, edges, connect);
        return;
      }
      for (std::size_t i = 0; i < edges.size(); ++i) {
        for (std::size_t j = i + 1; j < edges.size(); ++j) connect(edges[i], edges[j]);
      }
    });
  });
  std::vector<BoundaryEdge> boundary = joined(
      alone.size(), [&](std::size_t i) -> const auto& { return alone[i]; });
  join_along_edges(mesh, BoundaryEdges(std::move(boundary), 1e-3 * radius), cos_angle, connected);
  return joined(
      connected.size(), [&](std::size_t i) -> const auto& { return connected[i]; });
}

SmoothComponents join_components(const SurfaceMesh& mesh, std::span<const Connection> connections,
                                 std::span<const std::uint8_t> dark) {
  geometry::DisjointSets joined(mesh.original.size());
  for_each_pair_of_sides(connections, [&](std::uint32_t a, std::uint32_t b) {
    if (dark.empty() || dark[a] == dark[b]) joined.join(a, b);
  });
  SmoothComponents components;
  components.of.assign(mesh.original.size(), none);
  for (std::uint32_t s = 0; s < mesh.original.size(); ++s) {
    const std::uint32_t first = joined.find(mesh.original[s]);
    components.of[s] = first == s ? components.count++ : components.of[first];
  }
  return components;
}

SmoothComponents find_smooth_components(const SurfaceMesh& mesh, double radius,
                                        double angle_degrees) {
  return join_components(mesh, find_connections(mesh, radius, angle_degrees));
}

}  // namespace photile::surface
