// How the material models of the file formats map to photile's.
#pragma once

#include "photile/scene.hpp"

namespace photile::scene_io {

/// At or below this glTF roughness a metal counts as a perfect mirror.
inline constexpr double mirror_roughness = 0.05;
/// At or above this metallic factor a surface counts as a metal.
inline constexpr double mirror_metallic = 0.99;
/// At or above this Phong exponent an MTL reflection (illum 3 and 5) counts as a perfect mirror.
inline constexpr float mirror_phong_exponent = 1000.0f;

/// Lambertian albedo for a surface whose file colour cannot be had.
inline constexpr float missing_albedo = 0.5f;

/// GGX alpha of a perceptual roughness in [0,1] (glTF, MTL Pr): its square, at least
/// PHOTILE_MIN_GGX_ALPHA.
float ggx_alpha_from_roughness(double roughness);

/// GGX alpha with the width of a Blinn-Phong lobe: sqrt(2 / (exponent + 2)), clamped
/// likewise. Source:
/// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", section 5.2.
float ggx_alpha_from_phong_exponent(double exponent);

/// Reflectance at normal incidence between air and a dielectric: ((n-1)/(n+1))^2.
double f0_from_index_of_refraction(double index);

/// What the metallic-roughness factors and the extensions on top of them say.
struct MetallicRoughness {
  glm::dvec3 base_color{1.0};
  double metallic = 1.0;
  double roughness = 1.0;
  double index_of_refraction = 1.5;  ///< KHR_materials_ior
  double specular_factor = 1.0;      ///< KHR_materials_specular
  glm::dvec3 specular_color{1.0};    ///< KHR_materials_specular
};

/// Sets the diffuse and specular part of `material`; smooth metals become mirrors. White stays
/// white under its specular lobe, since the reflection model (device/bsdf.h) mixes the two by
/// Fresnel's law as glTF does.
void set_metallic_roughness(const MetallicRoughness& model, Material& material);

/// Scales diffuse and specular together where their sum exceeds 1 in a channel. True if it did.
bool conserve_energy(Material& material);

}  // namespace photile::scene_io
