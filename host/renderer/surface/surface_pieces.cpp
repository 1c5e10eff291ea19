#include "surface/surface_pieces.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "photile/device/surface.h"

namespace photile::surface {
namespace {

/// Tells for a triangle whether another plane of similar normal comes near it.
class NearbyPlanes {
 public:
  NearbyPlanes(const SurfaceMesh& mesh, const PlaneTree& planes, double radius,
               double angle_degrees)
      : mesh_(mesh),
        planes_(planes),
        radius_(radius),
        // Rather a triangle too many than one too few where the kernels round.
        least_cosine_(std::cos(glm::radians(angle_degrees)) - 1e-5) {}

  bool near(std::uint32_t triangle) const {
    bool found = false;
    planes_.visit_others(
        triangle, geometry::triangle_box(mesh_.scene, triangle), radius_, [&](std::uint32_t other) {
          const double cosine = glm::dot(mesh_.normal[triangle], mesh_.normal[other]);
          return found = !(std::abs(cosine) < least_cosine_);
        });
    return found;
  }

 private:
  const SurfaceMesh& mesh_;
  const PlaneTree& planes_;
  double radius_, least_cosine_;
};

SurfacePiece border_piece(const BorderEdge& edge, std::uint32_t facet) {
  SurfacePiece piece{.a = edge.from,
                     .b = edge.to,
                     .c = edge.inward,
                     .facet = facet,
                     .triangle = edge.triangle | PHOTILE_PIECE_BORDER};
  piece.box.extend(edge.from);
  piece.box.extend(edge.to);
  return piece;
}

}  // namespace

std::vector<SurfacePiece> find_pieces(const SurfaceMesh& mesh, const Facets& facets,
                                      const PlaneTree& planes, std::span<const DarkPart> dark_parts,
                                      double radius, double angle_degrees) {
  const NearbyPlanes nearby(mesh, planes, radius, angle_degrees);
  std::vector<std::uint8_t> is_piece(mesh.corner.size(), 0);
  tbb::parallel_for(std::size_t{0}, is_piece.size(), [&](std::size_t i) {
    const auto triangle = static_cast<std::uint32_t>(i);
    if (!mesh.counts(triangle)) return;
    is_piece[i] = facets.of_triangle[i] == PHOTILE_NO_FACET || nearby.near(triangle);
  });
  std::vector<SurfacePiece> pieces;
  for (const BorderEdge& edge : facets.borders) {
    pieces.push_back(border_piece(edge, facets.of_triangle[edge.triangle]));
  }
  for (const DarkPart& part : dark_parts) {
    const auto& [a, b, c] = part.corner;
    SurfacePiece piece{.a = a,
                       .b = b,
                       .c = c,
                       .facet = PHOTILE_NO_FACET,
                       .triangle = triangle_of(part.sided_triangle),
                       .dark_side = part.sided_triangle};
    for (const glm::vec3& corner : part.corner) piece.box.extend(corner);
    pieces.push_back(piece);
  }
  for (std::uint32_t t = 0; t < is_piece.size(); ++t) {
    if (is_piece[t] == 0) continue;
    const auto [a, b, c] = mesh.scene.corners(t);
    pieces.push_back({.box = geometry::triangle_box(mesh.scene, t),
                      .a = a,
                      .b = b,
                      .c = c,
                      .facet = facets.of_triangle[t],
                      .triangle = t});
  }
  return pieces;
}

}  // namespace photile::surface
