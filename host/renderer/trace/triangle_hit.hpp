// Where a ray meets a triangle.
#pragma once

#include <cstdint>

namespace photile::trace {

/// A point of a triangle of the scene.
struct TriangleHit {
  std::uint32_t triangle;
  float u, v;  ///< barycentric weights of the second and third corner
};

}  // namespace photile::trace
