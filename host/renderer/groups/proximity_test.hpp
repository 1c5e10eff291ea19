// Whether two triangles are neighbours: cheap bounds first, the exact distance where they leave it
// open.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "photile/scene.hpp"

namespace photile::groups {

/// What the cheap tests read of a triangle: one cache line.
struct alignas(64) TriangleBound {
  glm::dvec3 centre;  ///< of the smallest enclosing ball; a point of the triangle
  double radius;      ///< of that ball, metres
  glm::dvec3 normal;  ///< of side 0
  std::uint32_t triangle;
};

/// Decides "triangle_triangle_distance() <= radius" for pairs of triangles of one scene.
class ProximityTest {
 public:
  ProximityTest(const Scene& scene, double radius);

  TriangleBound bound(std::uint32_t triangle) const;

  /// Symmetric, bit for bit: the pair is always tested in the order of its indices.
  bool within(const TriangleBound& a, const TriangleBound& b) const {
    const glm::dvec3 offset = a.centre - b.centre;
    const double squared = glm::dot(offset, offset);
    const double farthest = outer_ + a.radius + b.radius;
    if (squared > farthest * farthest) return false;
    if (squared <= squared_inner_) return true;
    return a.triangle < b.triangle ? within_by_corners(a, b) : within_by_corners(b, a);
  }

 private:
  bool within_by_corners(const TriangleBound& a, const TriangleBound& b) const;

  const Scene& scene_;
  double radius_;
  // The cheap tests decide only where the answer is clear of the rounding of either computation, so
  // that the groups are the same as those of testing all pairs exactly.
  double outer_;          ///< farther than this is certainly outside
  double squared_inner_;  ///< square of the distance that is certainly within; negative if none
};

}  // namespace photile::groups
