#include "reading/import_context.hpp"

#include <utility>

#include "pictures/textures.hpp"
#include "scene/surface_models.hpp"

namespace photile::reading {

namespace {

Material without_textures(const Scene& scene, Material material) {
  material.name += " (without textures)";
  const bool colored = material.diffuse_texture != none;
  const std::uint32_t varying = std::exchange(material.metallic_roughness, none);
  if (colored) pictures::use_missing_texture_colour(material);
  if (varying != none) {
    MetallicRoughness model = scene.metallic_roughness[varying];
    model.texture = model.specular_texture = model.specular_color_texture = none;
    if (colored) model.base_color = glm::dvec3(scene::missing_albedo);
    scene::set_metallic_roughness(model, material);
  }
  material.opacity_texture = none;
  material.normal_texture = none;
  return material;
}

}  // namespace

std::uint32_t PlainMaterials::of(std::uint32_t material) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, is_new] = index_.try_emplace(material, next);
  if (is_new) scene_.materials.push_back(without_textures(scene_, scene_.materials[material]));
  return entry->second;
}

}  // namespace photile::reading
