#include "reading/import_context.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

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

bool ImportContext::is_hidden(const std::string& name) {
  has_hidden_.resize(options.hidden.size());
  bool hidden = false;
  for (std::size_t i = 0; i < options.hidden.size(); ++i) {
    if (::fnmatch(options.hidden[i].c_str(), name.c_str(), 0) != 0) continue;
    has_hidden_[i] = hidden = true;
  }
  return hidden;
}

void ImportContext::check_hidden() const {
  for (std::size_t i = 0; i < options.hidden.size(); ++i) {
    if (i < has_hidden_.size() && has_hidden_[i]) continue;
    throw UsageError(
        fmt::format("--set hide={}: {} has no such node, mesh, object or group; photile "
                    "info lists them",
                    options.hidden[i], folder.scene_file().string()));
  }
}

std::uint32_t PlainMaterials::of(std::uint32_t material) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, is_new] = index_.try_emplace(material, next);
  if (is_new) scene_.materials.push_back(without_textures(scene_, scene_.materials[material]));
  return entry->second;
}

}  // namespace photile::reading
