// Where the positions of a scene are counted from.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace photile::reading {

/// Finds the origin of a scene (Scene::origin) from its triangles, before they are rounded to
/// float.
///
/// Rounding moves a corner by its distance from the origin times 2^-24. What that does to a
/// triangle depends on its size, so the origin is the point from which the corners' distances, in
/// units of their triangle's longest edge, have the least sum of squares: the mean of the corners,
/// weighted with 1 / longest edge^2. In a landscape with one lamp that is the lamp.
class SceneOrigin {
 public:
  /// Counts a triangle. One with a corner beyond the limit, or with all in one point, does not
  /// count.
  void add(const std::array<glm::dvec3, 3>& corners);

  /// The origin, in coordinates that are floats. That of the file, (0, 0, 0), unless it is so far
  /// from the triangles that another one is worth the change: their corners then lie beyond 2^10
  /// longest edges from it (root mean square) and at most a 16th as far from the new one.
  glm::dvec3 best() const;

 private:
  std::uint64_t corners_ = 0;
  double weight_ = 0;
  glm::dvec3 sum_{0.0};  ///< weight x corner
  double squares_ = 0;   ///< weight x squared distance from (0, 0, 0)
};

}  // namespace photile::reading
