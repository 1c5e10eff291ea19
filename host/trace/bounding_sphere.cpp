#include <cmath>

#include "photile/scene.hpp"

namespace photile {

BoundingSphere bounding_sphere(const Scene& scene) {
  if (scene.triangles.empty()) return {};
  glm::dvec3 low(scene.corners(0)[0]), high = low;
  for (std::size_t t = 0; t < scene.triangle_count(); ++t)
    for (const glm::vec3& corner : scene.corners(t)) {
      low = glm::min(low, glm::dvec3(corner));
      high = glm::max(high, glm::dvec3(corner));
    }
  BoundingSphere sphere{0.5 * (low + high), 0.0};
  for (std::size_t t = 0; t < scene.triangle_count(); ++t)
    for (const glm::vec3& corner : scene.corners(t))
      sphere.radius = std::fmax(sphere.radius, glm::distance(sphere.center, glm::dvec3(corner)));
  return sphere;
}

}  // namespace photile
