#include "scene/surface_models.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "photile/device/bsdf.h"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "scene/panes.hpp"

namespace photile::scene {

namespace {

constexpr double min_alpha = PHOTILE_MIN_GGX_ALPHA;

}  // namespace

float ggx_alpha_from_roughness(double roughness) {
  return static_cast<float>(std::clamp(roughness * roughness, min_alpha, 1.0));
}

float ggx_alpha_from_phong_exponent(double exponent) {
  const double alpha = std::sqrt(2.0 / (std::max(exponent, 0.0) + 2.0));
  return static_cast<float>(std::clamp(alpha, min_alpha, 1.0));
}

double f0_from_index_of_refraction(double index) {
  const double ratio = (index - 1.0) / (index + 1.0);
  return ratio * ratio;
}

Reflectance reflectance_of(const MetallicRoughness& model) {
  const glm::dvec3 base = glm::clamp(model.base_color, 0.0, 1.0);
  const double metallic = std::clamp(model.metallic, 0.0, 1.0);
  const double factor = std::clamp(model.specular_factor, 0.0, 1.0);
  const glm::dvec3 dielectric =
      glm::min(f0_from_index_of_refraction(model.index_of_refraction) * model.specular_color,
               glm::dvec3(1.0)) *
      factor;
  return {glm::vec3(base * (1.0 - metallic)),
          glm::vec3(glm::clamp(glm::mix(dielectric, base, metallic), 0.0, 1.0)),
          static_cast<float>(glm::mix(factor, 1.0, metallic)),
          ggx_alpha_from_roughness(std::clamp(model.roughness, 0.0, 1.0))};
}

void set_metallic_roughness(const MetallicRoughness& model, Material& material) {
  const Reflectance reflectance = reflectance_of(model);
  const bool no_diffuse = glm::clamp(model.base_color, 0.0, 1.0) == glm::dvec3(0.0) ||
                          model.metallic >= mirror_metallic;
  const bool varies = model.texture != none || model.specular_texture != none ||
                      model.specular_color_texture != none;
  material.specular = reflectance.f0;
  material.f90 = reflectance.f90;
  if (no_diffuse && !varies && material.diffuse_texture == none &&
      model.roughness <= mirror_roughness && reflectance.f0 != glm::vec3(0.0f)) {
    material.interaction = Interaction::mirror;
    material.diffuse = glm::vec3(0.0f);
    return;
  }
  material.interaction = Interaction::opaque;
  material.diffuse = reflectance.albedo;
  material.roughness = reflectance.alpha;
}

bool conserve_energy(Material& material) {
  const glm::vec3 sum = material.diffuse + material.specular;
  const float largest = std::max({sum.r, sum.g, sum.b});
  // Factors such as 0.9 + 0.1 round to a little more than 1: not worth a warning.
  constexpr float tolerance = 1.0f + 1e-5f;
  if (largest <= 1.0f) return false;
  material.diffuse /= largest;
  material.specular /= largest;
  return largest > tolerance;
}

}  // namespace photile::scene

namespace photile {

namespace {

void add_needs(const Material& material, SceneNeeds& needs) {
  const bool mapped =
      material.interaction == Interaction::opaque && material.normal_texture != none;
  needs.normal_maps |= mapped;
  needs.glossy |= material.glossy() || mapped;  // both ask where light comes from
  needs.textures |= material.textured();
  needs.specular_paths |= material.interaction != Interaction::opaque;
  needs.see_through |= material.has_cutouts() || scene::is_pane(material);
}

/// Cosine above which two normals are the same up to the rounding of files: 0.15 degrees.
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

namespace photile::scene {

namespace {

constexpr int cosines = 64;  // of the light's directions

/// Points of all surface of a material at which its texture is read, and of each triangle at least.
constexpr double points_on_surface = 65'536;
constexpr int least_points = 4;

/// Point i of a sequence that fills a triangle evenly: the weights of its second and third corner
/// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018: R2, folded).
glm::vec2 point_in_triangle(int i) {
  constexpr double step_u = 0.7548776662466927, step_v = 0.5698402909980532;
  double u = std::fmod(0.5 + step_u * i, 1.0), v = std::fmod(0.5 + step_v * i, 1.0);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return {static_cast<float>(u), static_cast<float>(v)};
}

glm::dvec3 mean_of_all_texels(const Texture& texture) {
  glm::dvec3 sum(0.0);
  const double count = static_cast<double>(texture.width()) * texture.height();
  for (int y = 0; y < texture.height(); ++y) {
    for (int x = 0; x < texture.width(); ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(texture.width()),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(texture.height()));
      sum += glm::dvec3(texture.sample(uv));
    }
  }
  return sum / std::max(1.0, count);
}

/// Of the colours, by area, on what the material's triangles show of its texture: most of an atlas
/// belongs to other things, or to none. Cut out texels are no surface. Of a material that no
/// triangle has, the mean of all texels.
glm::dvec3 mean_texel(const Scene& scene, const Material& material) {
  if (material.diffuse_texture == none) return glm::dvec3(1.0);
  const Texture& texture = scene.textures[material.diffuse_texture];
  const Texture* const cutouts =
      material.opacity_texture == none ? nullptr : &scene.textures[material.opacity_texture];
  const auto opacity_at = [&](const glm::vec2& uv) {
    if (!cutouts) return 1.0;
    const float opacity = material.opacity * cutouts->sample_data(uv).a;
    if (material.opacity_cutoff > 0) return opacity >= material.opacity_cutoff ? 1.0 : 0.0;
    return static_cast<double>(std::clamp(opacity, 0.0f, 1.0f));
  };
  std::vector<std::uint32_t> triangles;
  double area = 0;
  for (std::uint32_t t = 0; t < scene.corner_uv.size(); ++t) {
    if (&scene.materials[scene.triangle_material[t]] != &material) continue;
    triangles.push_back(t);
    area += triangle_area(scene, t);
  }
  glm::dvec3 sum(0.0);
  double weight = 0;
  for (const std::uint32_t t : triangles) {
    const double part = triangle_area(scene, t);
    const int points =
        std::max(least_points, static_cast<int>(std::ceil(points_on_surface * part / area)));
    const auto& [a, b, c] = scene.corner_uv[t];
    for (int i = 0; i < points; ++i) {
      const glm::vec2 at = point_in_triangle(i);
      const glm::vec2 uv = a + at.x * (b - a) + at.y * (c - a);
      const double counts = part / points * opacity_at(uv);
      sum += counts * glm::dvec3(texture.sample(uv));
      weight += counts;
    }
  }
  return weight > 0 ? sum / weight : mean_of_all_texels(texture);
}

/// The surface of a mean texel. Textures that vary roughness or metal are left out: their factors
/// stand for them.
Reflectance mean_surface(const Scene& scene, const Material& material, const glm::dvec3& texel) {
  if (material.metallic_roughness != none) {
    MetallicRoughness model = scene.metallic_roughness[material.metallic_roughness];
    model.base_color *= texel;
    return reflectance_of(model);
  }
  return {material.diffuse * glm::vec3(texel), material.specular,
          material.glossy() ? material.f90 : 0.0f, material.roughness};
}

double whole_of(const Reflectance& surface) {
  return luminance(hemispherical_reflectance(surface));
}

/// Whether it reflects as metals do, and no light from below its surface: diamond, of the densest
/// of what is clear, has an F0 of 0.17.
bool is_metal(const Material& material) {
  return material.diffuse == glm::vec3(0.0f) && luminance(glm::dvec3(material.specular)) > 0.2;
}

void scale_color(Scene& scene, Material& material, glm::vec3& color, const glm::vec3& base,
                 const glm::dvec3& model_base, double scale) {
  color = base * static_cast<float>(scale);
  if (material.metallic_roughness != none) {
    scene.metallic_roughness[material.metallic_roughness].base_color = model_base * scale;
  }
}

}  // namespace

glm::dvec3 hemispherical_reflectance(const Reflectance& surface) {
  if (surface.f0 == glm::vec3(0.0f) && surface.f90 == 0.0f) return glm::dvec3(surface.albedo);
  PhotileAlbedoFit fit;
  photile_albedo_fit(surface.alpha, &fit);
  float mean[2];
  photile_mean_lobe_albedo(surface.alpha, &mean[0], &mean[1]);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < cosines; ++i) {
    const auto cosine = static_cast<float>(std::sqrt((i + 0.5) / cosines));  // by the cosine law
    float o[2];
    photile_lobe_albedo(&fit, cosine, &o[0], &o[1]);
    for (int c = 0; c < 3; ++c) {
      float part[3];
      photile_set_diffuse(surface.albedo[c], surface.f0[c], surface.f90, o, mean, part);
      const float base = PHOTILE_PI * photile_diffuse(part[0], part[1], part[2], mean[0], mean[1]);
      sum[c] += static_cast<double>(o[0] * surface.f0[c] + o[1] * surface.f90 + base);
    }
  }
  return glm::min(sum / static_cast<double>(cosines), glm::dvec3(1.0));
}

std::optional<MaterialReflectance> reflectance_of(const Scene& scene, const Material& material) {
  if (material.interaction == Interaction::glass) {
    if (!material.thin) return std::nullopt;
    return MaterialReflectance{glass_reflectance(material), 0};
  }
  const double there = is_pane(material) ? double{material.opacity} : 1;
  if (material.interaction == Interaction::mirror) {
    return MaterialReflectance{there * luminance(glm::dvec3(material.specular)), 0};
  }
  const Reflectance surface = mean_surface(scene, material, mean_texel(scene, material));
  return MaterialReflectance{there * whole_of(surface),
                             there * luminance(glm::dvec3(surface.albedo))};
}

namespace {

/// set_reflectance of the part of a surface that is there.
bool set_surface_reflectance(Scene& scene, Material& material, double fraction) {
  if (material.interaction == Interaction::mirror) {
    const double now = luminance(glm::dvec3(material.specular));
    if (!(now > 0)) return fraction == 0;
    material.specular *= static_cast<float>(fraction / now);
    return std::max({material.specular.r, material.specular.g, material.specular.b}) <= 1.0f;
  }
  glm::vec3& color = is_metal(material) ? material.specular : material.diffuse;
  if (color == glm::vec3(0.0f) && material.metallic_roughness == none) color = glm::vec3(1.0f);
  const glm::vec3 base = color;
  const glm::dvec3 model_base =
      material.metallic_roughness == none
          ? glm::dvec3(1.0)
          : scene.metallic_roughness[material.metallic_roughness].base_color;
  const glm::dvec3 widest = material.metallic_roughness == none ? glm::dvec3(base) : model_base;
  const glm::dvec3 texel = mean_texel(scene, material);
  // The scale at which a channel is 1; the reflectance grows with it.
  double high = 1 / std::max({widest.r, widest.g, widest.b, 1e-6}), low = 0;
  const auto at = [&](double scale) {
    scale_color(scene, material, color, base, model_base, scale);
    return whole_of(mean_surface(scene, material, texel));
  };
  constexpr double slack = 1e-6;
  if (at(low) > fraction + slack || at(high) < fraction - slack) {
    scale_color(scene, material, color, base, model_base, 1);
    return false;
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (at(middle) < fraction ? low : high) = middle;
  }
  at(0.5 * (low + high));
  return true;
}

}  // namespace

bool set_reflectance(Scene& scene, Material& material, double fraction) {
  if (material.interaction == Interaction::glass) {
    return material.thin && set_glass_reflectance(material, fraction);
  }
  if (!is_pane(material)) return set_surface_reflectance(scene, material, fraction);
  const double of_surface = fraction > 0 ? fraction / double{material.opacity} : 0;
  if (of_surface > 1) return false;
  if (set_surface_reflectance(scene, material, of_surface)) return true;
  // A pane whose colour is too dark for it is grey.
  Material grey = material;
  grey.diffuse = glm::vec3(1.0f);
  grey.diffuse_texture = grey.metallic_roughness = none;
  if (!set_surface_reflectance(scene, grey, of_surface)) return false;
  material = grey;
  return true;
}

}  // namespace photile::scene
