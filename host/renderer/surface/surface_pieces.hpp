// What the area of a disc is put together from: border edges of facets, and triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/triangle_bvh.hpp"
#include "photile/surface_index.hpp"
#include "surface/facets.hpp"
#include "surface/plane_tree.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::surface {

/// As PhotileSurfaceLeaf describes it, and its box.
struct SurfacePiece {
  geometry::Box box = {};
  glm::vec3 a{0.0f}, b{0.0f}, c{0.0f};
  std::uint32_t facet = 0;
  std::uint32_t triangle = 0;      ///< with PHOTILE_PIECE_BORDER where it is a border edge
  std::uint32_t dark_side = none;  ///< sided triangle of which it is a dark part
};

/// All border edges, dark parts, and those triangles that hits must look at: triangles of small
/// facets, and those within the radius of a triangle in another plane whose normal agrees with
/// theirs on one side or the other. The middle of a floor is neither.
std::vector<SurfacePiece> find_pieces(const SurfaceMesh& mesh, const Facets& facets,
                                      const PlaneTree& planes, std::span<const DarkPart> dark_parts,
                                      double radius, double angle_degrees);

}  // namespace photile::surface
