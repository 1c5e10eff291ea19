#include "photile/scene_needs.hpp"

#include <vector>

#include "photile/light_groups.hpp"
#include "scene/material_needs.hpp"

namespace photile {
namespace {

void add_needs(const Material& material, SceneNeeds& needs) {
  needs.glossy |= material.glossy();
  needs.textures |= material.diffuse_texture != none;
  needs.specular_paths |= material.interaction != Interaction::opaque;
  needs.panes |= material.interaction == Interaction::glass && material.thin;
}

}  // namespace

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
