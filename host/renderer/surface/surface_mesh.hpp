// The triangles of a scene with what they share: corners, edges, positions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/scene.hpp"

namespace photile::surface {

/// One edge of one triangle. The triangle's side 0 goes round it counter-clockwise.
struct MeshEdge {
  std::uint32_t low, high;  ///< welded corners, low < high
  std::uint32_t triangle;
  std::uint8_t index;  ///< from corner `index` to the next one
  bool forward;        ///< that leads from `low` to `high`
};

/// Corners are welded where their positions are the same bits, triangles where their corners are.
struct SurfaceMesh {
  explicit SurfaceMesh(const Scene& scene);

  /// Edges with the same two corners, which are consecutive in `edges`.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for_each_edge_from(0, edges.size(), visit);
  }

  /// Visits the pairs that begin in a part of all edges: parts may be visited in parallel.
  template <class Visit>
  void for_each_edge_of(std::size_t chunk, const Visit& visit) const {
    const auto begin_of = [&](std::size_t i) {
      i = std::min(i * edges_per_chunk, edges.size());
      while (i > 0 && i < edges.size() && alike(edges[i - 1], edges[i])) ++i;
      return i;
    };
    for_each_edge_from(begin_of(chunk), begin_of(chunk + 1), visit);
  }
  std::size_t edge_chunks() const { return (edges.size() + edges_per_chunk - 1) / edges_per_chunk; }

  const Scene& scene;
  std::vector<std::array<std::uint32_t, 3>> corner;  ///< welded, per triangle
  /// Per oriented face: the first that coincides with it and stores photons as it does.
  std::vector<std::uint32_t> original;
  std::vector<glm::dvec3> normal;  ///< of side 0, per triangle
  std::vector<MeshEdge> edges;     ///< of triangles that are their own originals

  /// Whether no earlier triangle coincides with it.
  bool counts(std::uint32_t triangle) const { return original[2 * triangle] == 2 * triangle; }
  /// Whether photons are stored on it: not on mirrors and glass.
  bool stores(std::uint32_t triangle) const {
    return scene.materials[scene.triangle_material[triangle]].interaction == Interaction::opaque;
  }

 private:
  static constexpr std::size_t edges_per_chunk = 8192;

  static bool alike(const MeshEdge& a, const MeshEdge& b) {
    return a.low == b.low && a.high == b.high;
  }

  template <class Visit>
  void for_each_edge_from(std::size_t first, std::size_t end, const Visit& visit) const {
    while (first < end) {
      std::size_t last = first + 1;
      while (last < end && alike(edges[first], edges[last])) ++last;
      visit(std::span(edges).subspan(first, last - first));
      first = last;
    }
  }
};

/// Which side of b's triangle continues a side of a's, where both have the same two corners: the
/// same one or the other.
inline std::uint32_t flip_between(const MeshEdge& a, const MeshEdge& b) {
  return a.forward == b.forward ? 1 : 0;
}

/// The cosine of the angle by which the surface folds at such an edge; below all cosines where
/// photons are stored on only one of its sides.
inline double fold_cosine(const SurfaceMesh& mesh, const MeshEdge& a, const MeshEdge& b) {
  if (mesh.stores(a.triangle) != mesh.stores(b.triangle)) return -2;
  const double cosine = glm::dot(mesh.normal[a.triangle], mesh.normal[b.triangle]);
  return flip_between(a, b) == 0 ? cosine : -cosine;
}

}  // namespace photile::surface
