#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "scene/surface_models.hpp"

namespace photile {
namespace {

void add_needs(const Material& material, SceneNeeds& needs) {
  const bool mapped =
      material.interaction == Interaction::opaque && material.normal_texture != none;
  needs.normal_maps |= mapped;
  needs.glossy |= material.glossy() || mapped;  // both ask where light comes from
  needs.textures |= material.textured();
  needs.specular_paths |= material.interaction != Interaction::opaque;
  needs.see_through |=
      material.has_holes() || (material.interaction == Interaction::glass && material.thin);
}

/// Cosine above which two normals are the same but for the rounding of files: 0.15 degrees.
constexpr float same_normal = 1.0f - 0x1p-18f;

/// Whether the vertex normals of a triangle bend its shading. A zero one stands for its own.
bool is_bent(const Scene& scene, std::uint32_t triangle) {
  const auto& normals = scene.corner_normal[triangle];
  if (std::find(normals.begin(), normals.end(), glm::vec3(0.0f)) != normals.end()) return false;
  const auto corners = scene.corners(triangle);
  const glm::dvec3 cross = glm::cross(glm::dvec3(corners[1]) - glm::dvec3(corners[0]),
                                      glm::dvec3(corners[2]) - glm::dvec3(corners[0]));
  const glm::vec3 own(glm::normalize(scene.front_side[triangle] == 0 ? cross : -cross));
  return std::any_of(normals.begin(), normals.end(),
                     [&](const glm::vec3& normal) { return glm::dot(own, normal) < same_normal; });
}

bool any_smooth_shading(const Scene& scene) {
  if (scene.corner_normal.empty()) return false;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const Material& material = scene.materials[scene.triangle_material[t]];
    if (material.interaction == Interaction::opaque && material.normal_texture == none &&
        is_bent(scene, t)) {
      return true;
    }
  }
  return false;
}

}  // namespace

SceneNeeds needs_of(const Scene& scene) {
  SceneNeeds needs;
  std::vector<bool> used(scene.materials.size(), false);
  for (const std::uint32_t material : scene.triangle_material) used[material] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (used[i]) add_needs(scene.materials[i], needs);  // glTF files carry unused materials
  }
  needs.smooth_shading = needs.normal_maps || any_smooth_shading(scene);
  needs.light_count = static_cast<std::uint32_t>(light_groups_of(scene).groups.size());
  return needs;
}

SceneNeeds scene::needs_of_materials(std::span<const Material> materials) {
  SceneNeeds needs;
  for (const Material& material : materials) add_needs(material, needs);
  return needs;
}

void scene::drop_flat_normals(Scene& scene, const SceneNeeds& of_materials) {
  if (of_materials.glossy || of_materials.specular_paths || any_smooth_shading(scene)) return;
  scene.corner_normal.clear();
}

}  // namespace photile
