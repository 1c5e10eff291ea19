// The unlit sides of smooth components that no photon reaches (the wall behind a cabinet, or above
// a ceiling), and the pieces from which the area of a disc is computed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box_tree.hpp"
#include "photile/photons.hpp"
#include "photile/surface_index.hpp"
#include "scene/coincident_faces.hpp"
#include "surface/coplanar_regions.hpp"
#include "surface/smooth_components.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::surface {

/// The most photons on dark surface, as a fraction of those expected there.
inline constexpr double most_found_in_the_dark = 0.005;

/// Per oriented face: 1 where photons are expected from the mean density of its component, but
/// almost none landed. Nearly empty triangles on which enough photons are expected for less than
/// one in a hundred to be empty by chance are judged together with those that they connect to, and
/// are dark where all of them together are.
///   components   those of `connections`
///   landed   per oriented face: the number of its photons
std::vector<std::uint8_t> find_unlit_sides(const SurfaceMesh& mesh,
                                           std::span<const Connection> connections,
                                           const SmoothComponents& components,
                                           std::span<const std::uint32_t> landed);

/// The parts of lit components where other, coincident faces count. Sides that are hidden as a
/// whole become dark, and have no parts; the same holds for those that coincide with what hides
/// them, with which they are one. In the order of the oriented faces.
///   components, landed   as in find_unlit_sides
std::vector<DarkPart> find_hidden_parts(const SurfaceMesh& mesh,
                                        const scene::CoincidentFaces& coincident,
                                        const SmoothComponents& components,
                                        std::span<const std::uint32_t> landed,
                                        std::vector<std::uint8_t>& dark);

/// Halves triangles, across the middles of their longest edges, as long as a half would hold 12
/// photons at the density of the denser half of its parent, and is not smaller than a thousandth of
/// the largest disc. A half on which almost no photons landed is a dark part. In the order of the
/// oriented faces.
///   photons   sorted by oriented face; several processes find those of all together
///   dark      sides that are dark as a whole, and have no parts
///   hidden    parts that are known, and are kept: their sides have no others
std::vector<DarkPart> find_unlit_regions(const SurfaceMesh& mesh, const Photons& photons,
                                         std::span<const std::uint8_t> dark,
                                         std::vector<DarkPart> hidden, double radius);

/// A piece of surface as PhotileSurfaceLeaf describes it, with its box.
struct SurfacePiece {
  geometry::Box box = {};
  glm::vec3 a{0.0f}, b{0.0f}, c{0.0f};
  std::uint32_t region = 0;
  std::uint32_t triangle = 0;       ///< with PHOTILE_PIECE_BORDER where it is a border edge
  std::uint32_t unlit_side = none;  ///< oriented face of which it is an unlit region
};

/// All border edges, unlit regions, and those triangles that hits must test: triangles of small
/// regions, and those within the radius of a triangle in another plane whose normal agrees with
/// theirs on one side or the other. The middle of a floor is neither.
std::vector<SurfacePiece> find_pieces(const SurfaceMesh& mesh, const CoplanarRegions& regions,
                                      const PlaneTree& planes,
                                      std::span<const DarkPart> unlit_regions, double radius,
                                      double angle_degrees);

}  // namespace photile::surface
