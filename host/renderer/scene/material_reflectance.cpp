#include "scene/material_reflectance.hpp"

#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"

namespace photile::scene {
namespace {

constexpr int cosines = 64;  // of the light's directions

glm::dvec3 mean_texel(const Texture& texture) {
  glm::dvec3 sum(0.0);
  const double count = static_cast<double>(texture.width()) * texture.height();
  for (int y = 0; y < texture.height(); ++y) {
    for (int x = 0; x < texture.width(); ++x) {
      const glm::vec2 place((static_cast<float>(x) + 0.5f) / static_cast<float>(texture.width()),
                            (static_cast<float>(y) + 0.5f) / static_cast<float>(texture.height()));
      sum += glm::dvec3(texture.sample(place));
    }
  }
  return sum / std::max(1.0, count);
}

/// The surface of a mean texel. Textures that vary roughness or metal are left out: their factors
/// stand for them.
Reflectance mean_surface(const Scene& scene, const Material& material) {
  const glm::vec3 texel = material.diffuse_texture == none
                              ? glm::vec3(1.0f)
                              : glm::vec3(mean_texel(scene.textures[material.diffuse_texture]));
  if (material.metallic_roughness != none) {
    MetallicRoughness model = scene.metallic_roughness[material.metallic_roughness];
    model.base_color *= glm::dvec3(texel);
    return reflectance_of(model);
  }
  return {material.diffuse * texel, material.specular, material.glossy() ? material.f90 : 0.0f,
          material.roughness};
}

double whole_of(const Reflectance& surface) {
  return luminance(hemispherical_reflectance(surface));
}

void scale_diffuse(Scene& scene, Material& material, const glm::vec3& base,
                   const glm::dvec3& model_base, double scale) {
  material.diffuse = base * static_cast<float>(scale);
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
  if (material.interaction == Interaction::glass) return std::nullopt;
  if (material.interaction == Interaction::mirror) {
    return MaterialReflectance{luminance(glm::dvec3(material.specular)), 0};
  }
  const Reflectance surface = mean_surface(scene, material);
  return MaterialReflectance{whole_of(surface), luminance(glm::dvec3(surface.albedo))};
}

bool set_reflectance(Scene& scene, Material& material, double share) {
  if (material.interaction == Interaction::glass) return false;
  if (material.interaction == Interaction::mirror) {
    const double now = luminance(glm::dvec3(material.specular));
    if (!(now > 0)) return share == 0;
    material.specular *= static_cast<float>(share / now);
    return std::max({material.specular.r, material.specular.g, material.specular.b}) <= 1.0f;
  }
  if (material.diffuse == glm::vec3(0.0f) && material.metallic_roughness == none) {
    material.diffuse = glm::vec3(1.0f);
  }
  const glm::vec3 base = material.diffuse;
  const glm::dvec3 model_base =
      material.metallic_roughness == none
          ? glm::dvec3(1.0)
          : scene.metallic_roughness[material.metallic_roughness].base_color;
  const glm::dvec3 widest = material.metallic_roughness == none ? glm::dvec3(base) : model_base;
  // The scale at which a channel is 1; the reflectance grows with it.
  double high = 1 / std::max({widest.r, widest.g, widest.b, 1e-6}), low = 0;
  const auto at = [&](double scale) {
    scale_diffuse(scene, material, base, model_base, scale);
    return whole_of(mean_surface(scene, material));
  };
  constexpr double slack = 1e-6;
  if (at(low) > share + slack || at(high) < share - slack) {
    scale_diffuse(scene, material, base, model_base, 1);
    return false;
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (at(middle) < share ? low : high) = middle;
  }
  at(0.5 * (low + high));
  return true;
}

}  // namespace photile::scene
