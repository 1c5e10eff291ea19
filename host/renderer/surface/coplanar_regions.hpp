// Coplanar regions: connected triangles in one plane, the edges that bound them, and what lies near
// a triangle in another plane.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box_tree.hpp"
#include "surface/surface_mesh.hpp"

namespace photile::surface {

struct BorderEdge {
  glm::vec3 from, to;
  glm::vec3 inward;  ///< unit, in the plane of the triangle, perpendicular to the edge
  std::uint32_t triangle;
};

struct CoplanarRegions {
  /// Per triangle: its region where hits test the region's border, PHOTILE_NO_REGION where they
  /// test the triangles, because these are few.
  std::vector<std::uint32_t> of_triangle;
  /// Per triangle: a number that the triangles of its region share, bordered or not.
  std::vector<std::uint32_t> plane;
  std::vector<BorderEdge> borders;  ///< of the regions in `of_triangle`
};

/// Grows regions from the largest triangles on. Normals within a region differ by less than the
/// slack of normals_agree, heights by less than a thousandth of the radius.
///   dark   per oriented face: a region ends where the value of one of its sides changes; or empty
CoplanarRegions find_coplanar_regions(const SurfaceMesh& mesh, double radius,
                                      std::span<const std::uint8_t> dark = {});

/// A hierarchy over the triangles that count, whose nodes store whether all of their triangles
/// belong to one region: the middle of a large wall is skipped at once, however finely it is
/// tessellated.
class PlaneTree {
 public:
  PlaneTree(const SurfaceMesh& mesh, const CoplanarRegions& regions);

  /// Calls visit(other) for triangles of other regions than `triangle` in leaves at most `radius`
  /// metres from `box`, until it returns true.
  template <class Visit>
  void visit_others(std::uint32_t triangle, const geometry::Box& box, double radius,
                    Visit&& visit) const {
    const std::uint32_t own = mesh_.counts(triangle) ? regions_.plane[triangle] : nothing;
    tree_.visit_within(
        box, geometry::squared_reach(radius),
        [&](std::size_t node) { return plane_[node] != own && plane_[node] != nothing; },
        [&](std::uint32_t other) {
          return mesh_.counts(other) && regions_.plane[other] != own && visit(other);
        });
  }

 private:
  static constexpr std::uint32_t several = none;      ///< regions below a node
  static constexpr std::uint32_t nothing = none - 1;  ///< no triangle that counts

  const SurfaceMesh& mesh_;
  const CoplanarRegions& regions_;
  geometry::BoxTree tree_;
  std::vector<std::uint32_t> plane_;  ///< per node: as CoplanarRegions::plane, or one of the above
};

}  // namespace photile::surface
