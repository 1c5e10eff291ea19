// The surface that a density estimate divides by: components, regions, and a tree over what bounds
// them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/device/surface.h"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile {

/// A part of a lit triangle that no photon reaches.
struct DarkPart {
  std::array<glm::vec3, 3> corner;
  std::uint32_t oriented_face;
};

/// The corners of least and of greatest coordinates.
struct PartBounds {
  glm::vec3 lower, upper;

  bool contain(const glm::vec3& position) const {
    return glm::all(glm::lessThanEqual(lower, position)) &&
           glm::all(glm::lessThanEqual(position, upper));
  }
};

/// The data of a scene that the area of a disc clipped to the surface follows from.
///
/// A *component* is a set of oriented faces that connect over edges which fold by no more than the
/// angle of the neighbour groups; coplanar pieces that touch connect, too. Light reaches a
/// component as a whole or not at all: the inside of a thin plate is a component on which no photon
/// lands. So where photons are to be expected and next to none landed (behind a cabinet, above a
/// ceiling), triangles are *dark*, and form separate components and regions.
///
/// A *region* is a set of connected triangles in one plane. A hit on a region wider than twice the
/// radius tests the edges that bound it, and not its triangles. Smaller regions, and those of
/// curved surfaces, are tested triangle by triangle.
///
/// Triangles that store no photons (mirrors, glass) form separate components and regions, which
/// stay dark. Coincident triangles count once.
///
/// A lit component may lie under others for the most part: the wall behind tiles is lit in the
/// joints. Its triangles count with the fraction of their area that lies open, except for hits on
/// that component.
///
/// *Unlit regions* of triangles count as holes in them wherever the triangles count, except for
/// hits that lie in an unlit region: those hits are dark.
struct SurfaceIndex {
  double radius = 0;         ///< metres: no disc is larger
  double angle_degrees = 0;  ///< largest angle between the normals of neighbours

  std::vector<std::uint32_t> original;  ///< per oriented face: the first that coincides with it
  /// Per triangle: its region where hits test the region's border, else PHOTILE_NO_REGION.
  std::vector<std::uint32_t> region;
  std::vector<std::uint32_t> component;  ///< per oriented face
  std::vector<glm::vec3> normal;         ///< per oriented face, unit
  std::vector<std::uint8_t> dark;        ///< per oriented face: 1 where next to no photon lands
  std::vector<float> open_fraction;      ///< per oriented face, in [0, 1]
  std::uint32_t components = 0;
  std::vector<DarkPart> unlit_regions;            ///< in the order of their oriented faces
  std::vector<std::uint32_t> first_unlit_region;  ///< per oriented face, and their number; or empty
  /// Each of `unlit_bounds` holds this many consecutive unlit regions, which usually lie beside
  /// each other: a hit on a wall with hundreds of them tests only a few.
  static constexpr std::uint32_t bounded_together = 4;
  std::vector<PartBounds> unlit_bounds;

  /// The component of a hit: of its triangle, or PHOTILE_UNLIT_REGION.
  std::uint32_t component_at(std::uint32_t oriented_face, const glm::vec3& position) const;

  /// Border edges of regions, and triangles near other regions of similar normal, in a tree whose
  /// root is node 0; no node where there are no such pieces.
  std::vector<PhotileSurfaceNode> nodes;
  std::vector<PhotileSurfaceLeaf> leaves;

  std::uint64_t bytes() const;
};

/// Finds components and regions and builds the tree. The result does not depend on the number of
/// threads.
///   radius          metres, > 0: of the largest disc
///   landed          per oriented face: photons that landed there; unlit surface that faces lit
///                   surface covers it
///   angle_degrees   largest angle between normals of neighbours, in [0, 180]
SurfaceIndex index_surface(const Scene& scene, const std::vector<std::uint32_t>& landed,
                           double radius, double angle_degrees);

/// Indexes the surface and finds its unlit regions.
///   photons   sorted by oriented face; where several processes hold them, all call this, each
///             with those of its own maps
SurfaceIndex index_surface(const Scene& scene, const Photons& photons, double radius,
                           double angle_degrees);

/// Photons on each oriented face, those of other processes among them (Photons::of_all).
std::vector<std::uint32_t> landed_on(const Scene& scene, const Photons& photons);

/// Per component: 1 where a photon landed that is not one of the few on dark triangles, else 0.
///   landed   per oriented face: photons that landed there
std::vector<std::uint8_t> lit_components(const SurfaceIndex& surface,
                                         const std::vector<std::uint32_t>& landed);

}  // namespace photile
