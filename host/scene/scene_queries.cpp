// Questions about a scene that several rooms ask.
#include <algorithm>

#include "photile/light_groups.hpp"
#include "photile/scene.hpp"
#include "scene/material_needs.hpp"

namespace photile {
namespace {

/// Twice the area, along the normal of side 0.
glm::dvec3 doubled_area_vector(const Scene& scene, std::uint32_t triangle) {
  const std::array<glm::vec3, 3> p = scene.corners(triangle);
  return glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
}

void add_needs(const Material& material, SceneNeeds& needs) {
  needs.glossy |= material.glossy();
  needs.textures |= material.diffuse_texture != none;
  needs.specular_paths |= material.interaction != Interaction::opaque;
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

SceneNeeds needs_of(const Scene& scene) {
  SceneNeeds needs;
  std::vector<bool> used(scene.materials.size(), false);
  for (const std::uint32_t material : scene.triangle_material) used[material] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (used[i]) add_needs(scene.materials[i], needs);  // glTF files carry unused materials
  }
  needs.light_count = static_cast<std::uint32_t>(light_groups_of(scene).groups.size());
  return needs;
}

SceneNeeds scene_io::needs_of_materials(std::span<const Material> materials) {
  SceneNeeds needs;
  for (const Material& material : materials) add_needs(material, needs);
  return needs;
}

}  // namespace photile
