#include "obj/mtl_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "files/warnings.hpp"
#include "photile/limits.hpp"
#include "scene/surface_models.hpp"

namespace photile::obj {
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

void warn_about_ignored(const tinyobj::material_t& source, files::Warnings& warnings) {
  const auto warn = [&](const std::string& message) {
    warnings.add("material", source.name, message);
  };
  const std::array<std::pair<const std::string*, const char*>, 8> textures{{
      {&source.specular_texname, "map_Ks"},
      {&source.specular_highlight_texname, "map_Ns"},
      {&source.bump_texname, "bump"},
      {&source.displacement_texname, "disp"},
      {&source.reflection_texname, "refl"},
      {&source.roughness_texname, "map_Pr"},
      {&source.metallic_texname, "map_Pm"},
      {&source.sheen_texname, "map_Ps"},
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
  return source.dissolve < 1 && source.ior > 1 && source.alpha_texname.empty();
}

void set_glass(const tinyobj::material_t& source, Material& material, files::Warnings& warnings) {
  // MTL files have an Ns of 0 or 1 where nobody thought of one.
  if (source.shininess > 1 && source.shininess < scene::mirror_phong_exponent) {
    warnings.add("material", source.name,
                 fmt::format("rough glass (Ns {:.4g}) is treated as smooth", source.shininess));
  }
  material.interaction = Interaction::glass;
  material.specular = glm::vec3(1.0f);
  const bool has_index = std::isfinite(source.ior) && source.ior > 1;
  material.index_of_refraction =
      static_cast<float>(has_index ? std::min(source.ior, limits::max_index_of_refraction)
                                   : default_index_of_refraction);
  // Tf is black where the file does not give it, and black glass would be of no use.
  const glm::vec3 tint = reflectance(source.transmittance);
  material.transmission = tint == glm::vec3(0.0f) ? glm::vec3(1.0f) : tint;
}

void set_mirror(const glm::vec3& specular, Material& material) {
  material.interaction = Interaction::mirror;
  material.specular = specular;
}

void set_surface(const tinyobj::material_t& source, bool lambertian, Material& material,
                 files::Warnings& warnings) {
  const bool has_texture = !source.diffuse_texname.empty();
  if (source.roughness > 0 || source.metallic > 0) {
    MetallicRoughness model;
    model.base_color = color(source.diffuse);
    model.metallic = source.metallic;
    model.roughness = source.roughness;
    if (lambertian) model.specular_factor = 0;
    scene::set_metallic_roughness(model, material);
    return;
  }
  if (is_glass(source)) return set_glass(source, material, warnings);
  const glm::vec3 diffuse = reflectance(source.diffuse), specular = reflectance(source.specular);
  const bool reflective_model = source.illum == 3 || source.illum == 5;
  const bool specular_model = source.illum == 2 || reflective_model;
  const bool black_diffuse = diffuse == glm::vec3(0.0f) && !has_texture;
  if (reflective_model && specular != glm::vec3(0.0f) &&
      (source.shininess >= scene::mirror_phong_exponent || black_diffuse)) {
    return set_mirror(specular, material);
  }
  material.diffuse = diffuse;
  if (specular_model && !lambertian) {
    material.specular = specular;
    material.roughness = scene::ggx_alpha_from_phong_exponent(source.shininess);
    if (scene::conserve_energy(material)) {
      warnings.add("material", source.name, "Kd + Ks exceeds 1; both are scaled");
    }
  }
}

/// A picture that the library names, as written on Windows or elsewhere. Errors: ResourceError.
std::uint32_t texture_named(std::string path, pictures::TextureStore& textures,
                            pictures::TextureContent content = pictures::TextureContent::color) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return textures.from_file(path, content);
}

/// A texture beside map_Kd; `none` where the material has none or it cannot be had.
std::uint32_t texture_or_none(const std::string& name, pictures::TextureContent content,
                              const std::string& substitute, const Material& material,
                              pictures::TextureStore& textures, reading::ImportContext& context) {
  if (name.empty()) return none;
  try {
    return texture_named(name, textures, content);
  } catch (const files::ResourceError& error) {
    context.warnings.add("material", material.name,
                         std::string(error.what()) + "; " + substitute + " is used instead");
    return none;
  }
}

/// d, Tr and map_d. Emission knows no holes: what shines stays whole.
void set_opacity(const tinyobj::material_t& source, bool emits, pictures::TextureStore& textures,
                 Material& material, reading::ImportContext& context) {
  if (material.interaction == Interaction::glass) return;
  // Some programs write Tr as they write d, and what is not there at all would not be in the file.
  const bool given = source.dissolve > 0 && source.dissolve < 1;
  const float opacity = given ? static_cast<float>(source.dissolve) : 1.0f;
  if (!(source.dissolve > 0)) {
    context.warnings.add("material", material.name, "d 0 (Tr 1) is treated as opaque");
  }
  const std::uint32_t texture = texture_or_none(
      source.alpha_texname, pictures::TextureContent::opacity, "d", material, textures, context);
  if (texture == none && opacity >= 1.0f) return;
  if (emits) {
    context.warnings.add("material", material.name,
                         "d, Tr or map_d of a material that emits is ignored; it has no holes");
    return;
  }
  material.opacity = opacity;
  material.opacity_texture = texture;
  if (opacity < 1.0f) {
    context.warnings.add("material", material.name,
                         "transparency (d, Tr) lets light through by chance, without refraction; "
                         "an Ni would make it glass");
  }
}

reading::Emission emission_of(const tinyobj::material_t& source, pictures::TextureStore& textures,
                              reading::ImportContext& context) {
  reading::Emission emission{color(source.emission) *
                             static_cast<double>(context.options.emissive_scale)};
  if (source.emissive_texname.empty() || emission.radiance == glm::dvec3(0.0)) return emission;
  try {
    emission.texture = texture_named(source.emissive_texname, textures);
  } catch (const files::ResourceError& error) {
    context.warnings.add("material", source.name,
                         std::string(error.what()) + "; its Ke is used alone");
  }
  return emission;
}

}  // namespace

void add_mtl_material(const tinyobj::material_t& source, pictures::TextureStore& textures,
                      reading::ImportContext& context) {
  Material material;
  material.name = source.name;
  set_surface(source, context.options.lambertian, material, context.warnings);
  warn_about_ignored(source, context.warnings);
  if (!source.diffuse_texname.empty() && material.interaction == Interaction::opaque) {
    try {
      material.diffuse_texture = texture_named(source.diffuse_texname, textures);
    } catch (const files::ResourceError& error) {
      pictures::use_missing_texture_colour(material);
      context.warnings.add("material", source.name,
                           std::string(error.what()) + "; mid grey (0.5) is used instead");
    }
  }
  material.normal_texture = texture_or_none(source.normal_texname, pictures::TextureContent::data,
                                            "no normal map", material, textures, context);
  const double scale = source.normal_texopt.bump_multiplier;
  if (std::isfinite(scale)) {
    material.normal_scale =
        static_cast<float>(std::clamp(scale, -limits::max_normal_scale, limits::max_normal_scale));
  }
  const reading::Emission emission = emission_of(source, textures, context);
  set_opacity(source, emission.radiance != glm::dvec3(0.0), textures, material, context);
  context.scene.materials.push_back(std::move(material));
  context.emission.push_back(emission);
}

void add_missing_material(const std::string& name, reading::ImportContext& context) {
  Material material;
  material.name = name;
  material.diffuse = glm::vec3(scene::missing_albedo);
  context.scene.materials.push_back(std::move(material));
  context.emission.emplace_back();
}

}  // namespace photile::obj
