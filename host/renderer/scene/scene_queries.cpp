// Questions about a scene that several rooms ask.
#include "photile/scene.hpp"
#include "photile/sensors.hpp"

namespace photile {
namespace {

/// Twice the area, along the normal of side 0.
glm::dvec3 doubled_area_vector(const Scene& scene, std::uint32_t triangle) {
  const std::array<glm::vec3, 3> p = scene.corners(triangle);
  return glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
}

}  // namespace

glm::dvec3 direction_in_scene(const Scene& scene, const glm::dvec3& world) {
  return scene.turn * world;
}

glm::dvec3 direction_in_world(const Scene& scene, const glm::dvec3& direction) {
  return glm::transpose(scene.turn) * direction;
}

glm::dvec3 place_in_scene(const Scene& scene, const glm::dvec3& world) {
  return direction_in_scene(scene, world) - scene.origin;
}

glm::dvec3 place_in_world(const Scene& scene, const glm::dvec3& place) {
  return direction_in_world(scene, place + scene.origin);
}

Camera in_world(const Scene& scene, Camera camera) {
  camera.position = place_in_world(scene, camera.position);
  for (glm::dvec3* axis : {&camera.forward, &camera.up, &camera.right}) {
    *axis = direction_in_world(scene, *axis);
  }
  return camera;
}

Camera in_scene(const Scene& scene, Camera camera) {
  camera.position = place_in_scene(scene, camera.position);
  for (glm::dvec3* axis : {&camera.forward, &camera.up, &camera.right}) {
    *axis = direction_in_scene(scene, *axis);
  }
  return camera;
}

Sensor in_scene(const Scene& scene, Sensor sensor) {
  sensor.position = place_in_scene(scene, sensor.position);
  sensor.normal = direction_in_scene(scene, sensor.normal);
  sensor.facing = direction_in_scene(scene, sensor.facing);
  return sensor;
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
