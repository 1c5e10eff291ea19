// Smooth components: oriented faces that connect over edges which fold by no more than an angle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/surface_mesh.hpp"

namespace photile::surface {

struct SmoothComponents {
  std::vector<std::uint32_t> of;  ///< per oriented face
  std::uint32_t count = 0;        ///< numbered in the order of their first oriented faces
};

/// Two triangles that continue each other across an edge: side i of one as side i ^ flip of the
/// other.
struct Connection {
  std::uint32_t a, b, flip;
  bool shared;  ///< both have this edge; else their edges run along each other
};

/// Calls visit(a, b) for the oriented faces that connect, each pair of a connection once.
template <class Visit>
void for_each_pair_of_sides(std::span<const Connection> connections, const Visit& visit) {
  for (const auto& [a, b, flip, shared] : connections) {
    for (const std::uint32_t side : {0u, 1u}) visit(oriented(a, side), oriented(b, side ^ flip));
  }
}

/// Triangles connect where they share both corners of an edge, or where their edges run along each
/// other, even where their ends differ (as with tiles); each pair once or more. Of the many that
/// share an edge in a fan not all pairs are listed, but enough of them to join the same triangles.
///   radius   metres: edges at most a thousandth of it apart run along each other
std::vector<Connection> find_connections(const SurfaceMesh& mesh, double radius,
                                         double angle_degrees);

/// The connections, without pairs of sides of which one is dark and the other is not.
///   dark   per oriented face, or empty
SmoothComponents join_components(const SurfaceMesh& mesh, std::span<const Connection> connections,
                                 std::span<const std::uint8_t> dark = {});

/// All connections.
SmoothComponents find_smooth_components(const SurfaceMesh& mesh, double radius,
                                        double angle_degrees);

}  // namespace photile::surface
