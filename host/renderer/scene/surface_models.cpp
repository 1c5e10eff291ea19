#include "scene/surface_models.hpp"

#include <algorithm>
#include <cmath>

#include "photile/device/bsdf.h"

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
