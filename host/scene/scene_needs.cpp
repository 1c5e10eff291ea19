#include "photile/scene_needs.hpp"

#include <vector>

#include "photile/light_groups.hpp"
#include "scene/material_needs.hpp"

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
