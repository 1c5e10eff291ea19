// Questions about a scene that several rooms ask.
#include "photile/scene.hpp"

namespace photile {
namespace {

/// Twice the area, along the normal of side 0.
glm::dvec3 doubled_area_vector(const Scene& scene, std::uint32_t triangle) {
  const std::array<glm::vec3, 3> p = scene.corners(triangle);
  return glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
}

}  // namespace

Camera in_world(const Scene& scene, Camera camera) {
  camera.position += scene.origin;
  return camera;
}

glm::dvec3 sided_normal(const Scene& scene, std::uint32_t sided_triangle) {
  const glm::dvec3 normal = glm::normalize(doubled_area_vector(scene, triangle_of(sided_triangle)));
  return side_of(sided_triangle) == 0 ? normal : -normal;
}

double triangle_area(const Scene& scene, std::uint32_t triangle) {
  return 0.5 * glm::length(doubled_area_vector(scene, triangle));
}

BoundingSphere bounding_sphere(const Scene& scene) {
  if (scene.vertices.empty()) return {};
  glm::dvec3 low(scene.vertices[0]), high = low;
  for (const glm::vec3& vertex : scene.vertices) {
    low = glm::min(low, glm::dvec3(vertex));
    high = glm::max(high, glm::dvec3(vertex));
  }
  return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

}  // namespace photile
