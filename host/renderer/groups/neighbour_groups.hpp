// Neighbour groups: whether two triangles are near each other, by cheap bounds first and by the
// exact distance where these do not decide, and the lists of both sides, found together.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/neighbour_groups.hpp"
#include "photile/scene.hpp"

namespace photile::groups {

/// The data of a triangle for the cheap tests: one cache line.
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

// A neighbour of a triangle (a triangle, or a patch) is kept as 4 * its index + these bits until
// the groups of both sides are written: equal sides agree, opposite sides agree.
inline constexpr std::uint32_t equal_sides = 1, opposite_sides = 2;

/// The normal test of photile::normals_agree for both pairs of sides. In single precision, as
/// kernels/structures/search.clh filters: the faces of a cylinder may have exactly the angle within
/// rounding, and every structure must decide alike.
inline std::uint32_t agreeing_sides(const glm::dvec3& a, const glm::dvec3& b, double cos_angle) {
  const glm::vec3 u(a), v(b);
  const float cosine = (u.x * v.x + u.y * v.y) + u.z * v.z;
  const float least = static_cast<float>(cos_angle - cosine_slack);
  return (cosine >= least ? equal_sides : 0) | (-cosine >= least ? opposite_sides : 0);
}

/// Appends the neighbours of a triangle, ascending.
using AppendNeighbours =
    std::function<void(std::uint32_t triangle, std::vector<std::uint32_t>& neighbours)>;

/// Errors: UsageError when the radius is not positive and finite or the angle is outside [0, 180].
void check(const NeighbourGroupParameters& parameters);

/// Groups of both sides of all triangles, searched in parallel. Errors: UsageError when they have
/// more members than limits.hpp allows; Interrupted.
///   landed   per oriented face: 1 where a group is requested, 0 where an empty one suffices;
///            empty: all are requested
NeighbourGroups collect_groups(std::size_t triangle_count,
                               const NeighbourGroupParameters& parameters,
                               const AppendNeighbours& append_neighbours, Progress& progress,
                               std::span<const std::uint8_t> landed = {});

}  // namespace photile::groups
