#include "scene/mtl_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/resource_error.hpp"
#include "scene/surface_models.hpp"

namespace photile::scene_io {
namespace {

constexpr double default_index_of_refraction = 1.5;  // where MTL asks for glass without an Ni

glm::dvec3 color(const tinyobj::real_t (&rgb)[3]) {
  glm::dvec3 result(rgb[0], rgb[1], rgb[2]);
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(result[c])) result[c] = 0.0;
  }
  return result;
}

glm::vec3 reflectance(const tinyobj::real_t (&rgb)[3]) {
  return glm::vec3(glm::clamp(color(rgb), 0.0, 1.0));
}

void warn_about_ignored(const tinyobj::material_t& source, Warnings& warnings) {
  const auto warn = [&](const std::string& message) {
    warnings.add("material", source.name, message);
  };
  const std::array<std::pair<const std::string*, const char*>, 10> textures{{
      {&source.specular_texname, "map_Ks"},
      {&source.specular_highlight_texname, "map_Ns"},
      {&source.bump_texname, "bump"},
      {&source.displacement_texname, "disp"},
      {&source.alpha_texname, "map_d"},
      {&source.reflection_texname, "refl"},
      {&source.roughness_texname, "map_Pr"},
      {&source.metallic_texname, "map_Pm"},
      {&source.sheen_texname, "map_Ps"},
      {&source.normal_texname, "norm"},
  }};
  for (const auto& [name, statement] : textures) {
    if (!name->empty())
      warn(std::string("texture ") + statement + " is ignored; its factor is used");
  }
  if (source.sheen > 0 || source.clearcoat_thickness > 0 || source.anisotropy > 0) {
    warn("sheen, clear coat and anisotropy are ignored");
  }
}

bool is_glass(const tinyobj::material_t& source) {
  constexpr std::array<int, 4> models{4, 6, 7, 9};
  if (std::find(models.begin(), models.end(), source.illum) != models.end()) return true;
  return source.dissolve < 1 && source.ior > 1;
}

void set_glass(const tinyobj::material_t& source, Material& material) {
  material.interaction = Interaction::glass;
  material.specular = glm::vec3(1.0f);
  const bool has_index = std::isfinite(source.ior) && source.ior > 1;
  material.index_of_refraction =
      static_cast<float>(has_index ? source.ior : default_index_of_refraction);
  // Tf is black where the file does not give it, and black glass would be of no use.
  const glm::vec3 tint = reflectance(source.transmittance);
  material.transmission = tint == glm::vec3(0.0f) ? glm::vec3(1.0f) : tint;
}

void set_mirror(const glm::vec3& specular, Material& material) {
  material.interaction = Interaction::mirror;
  material.specular = specular;
}

void set_surface(const tinyobj::material_t& source, Material& material, Warnings& warnings) {
  const bool has_texture = !source.diffuse_texname.empty();
  if (source.roughness > 0 || source.metallic > 0) {
    MetallicRoughness model;
    model.base_color = color(source.diffuse);
    model.metallic = source.metallic;
    model.roughness = source.roughness;
    set_metallic_roughness(model, material);
    return;
  }
  if (is_glass(source)) return set_glass(source, material);
  if (source.dissolve < 1) {
    warnings.add("material", source.name, "transparency (d, Tr) without Ni is treated as opaque");
  }
  const glm::vec3 diffuse = reflectance(source.diffuse), specular = reflectance(source.specular);
  const bool reflective_model = source.illum == 3 || source.illum == 5;
  const bool specular_model = source.illum == 2 || reflective_model;
  const bool black_diffuse = diffuse == glm::vec3(0.0f) && !has_texture;
  if (reflective_model && specular != glm::vec3(0.0f) &&
      (source.shininess >= mirror_phong_exponent || black_diffuse)) {
    return set_mirror(specular, material);
  }
  material.diffuse = diffuse;
  if (specular_model) {
    material.specular = specular;
    material.roughness = ggx_alpha_from_phong_exponent(source.shininess);
    if (conserve_energy(material)) {
      warnings.add("material", source.name, "Kd + Ks exceeds 1; both are scaled");
    }
  }
}

/// A picture that the library names, as written on Windows or elsewhere. Errors: ResourceError.
std::uint32_t texture_named(std::string path, TextureStore& textures) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return textures.from_file(path);
}

Emission emission_of(const tinyobj::material_t& source, TextureStore& textures,
                     ImportContext& context) {
  Emission emission{color(source.emission) * static_cast<double>(context.options.emissive_scale)};
  if (source.emissive_texname.empty() || emission.radiance == glm::dvec3(0.0)) return emission;
  try {
    emission.texture = texture_named(source.emissive_texname, textures);
  } catch (const ResourceError& error) {
    context.warnings.add("material", source.name,
                         std::string(error.what()) + "; its Ke is used alone");
  }
  return emission;
}

}  // namespace

void add_mtl_material(const tinyobj::material_t& source, TextureStore& textures,
                      ImportContext& context) {
  Material material;
  material.name = source.name;
  set_surface(source, material, context.warnings);
  warn_about_ignored(source, context.warnings);
  if (!source.diffuse_texname.empty() && material.interaction == Interaction::opaque) {
    try {
      material.diffuse_texture = texture_named(source.diffuse_texname, textures);
    } catch (const ResourceError& error) {
      use_missing_texture_colour(material);
      context.warnings.add("material", source.name,
                           std::string(error.what()) + "; mid grey (0.5) is used instead");
    }
  }
  context.scene.materials.push_back(std::move(material));
  context.emission.push_back(emission_of(source, textures, context));
}

void add_missing_material(const std::string& name, ImportContext& context) {
  Material material;
  material.name = name;
  material.diffuse = glm::vec3(missing_albedo);
  context.scene.materials.push_back(std::move(material));
  context.emission.emplace_back();
}

}  // namespace photile::scene_io
