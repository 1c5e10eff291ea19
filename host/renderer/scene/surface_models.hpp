// How the material models of the file formats map to photile's, and how much light they reflect.
#pragma once

#include <optional>
#include <span>

#include "photile/scene.hpp"

namespace photile::scene {

/// At or below this glTF roughness a metal counts as a perfect mirror.
inline constexpr double mirror_roughness = 0.05;
/// At or above this metallic factor a surface counts as a metal.
inline constexpr double mirror_metallic = 0.99;
/// At or above this Phong exponent an MTL reflection (illum 3 and 5) counts as a perfect mirror.
inline constexpr float mirror_phong_exponent = 1000.0f;

/// Lambertian albedo of a surface whose colour cannot be read from its file.
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

/// The reflection of an opaque surface at a point: the parameters of device/bsdf.h.
struct Reflectance {
  glm::vec3 albedo{0.0f};  ///< of the Lambertian base
  glm::vec3 f0{0.0f};      ///< of the coat
  float f90 = 1.0f;
  float alpha = 1.0f;  ///< GGX
};

/// The model's factors, clamped to what it allows, as albedo, F0, F90 and alpha: glTF 2.0, appendix
/// B.3.5, and KHR_materials_specular. A dielectric's F0 is that of its index times the specular
/// colour and factor, its F90 the factor; a metal's are the base colour and 1; between the two they
/// are mixed. Textures are left out.
Reflectance reflectance_of(const MetallicRoughness& model);

/// Sets the diffuse and specular part of `material`; smooth metals without textures become mirrors.
void set_metallic_roughness(const MetallicRoughness& model, Material& material);

/// Scales diffuse and specular together where their sum exceeds 1 in a channel. True if it did.
bool conserve_energy(Material& material);

/// The needs of these materials, whether or not a triangle has them: importers must decide what to
/// read of a mesh before its first triangle. light_count stays 0.
SceneNeeds needs_of_materials(std::span<const Material> materials);

/// Removes shading normals where they are not needed: all equal those of their triangles, or lie on
/// what scatters no light, and according to the needs no material is specular or glossy.
void drop_flat_normals(Scene& scene, const SceneNeeds& of_materials);

/// The fraction of light from all directions that an opaque surface sends back, per channel: the
/// reflectance of lighting tables. Within 2% of what the BSDF scatters, by the fits of its albedo.
glm::dvec3 hemispherical_reflectance(const Reflectance& surface);

/// What lighting design calls a material's reflectance: luminous, for light from all directions.
struct MaterialReflectance {
  double whole = 0;
  double matt = 0;  ///< of the diffuse colour alone, as in the file
};

/// With a texture, the mean by area of the part that the surface shows. For panes, that of their
/// whole surface (panes.hpp). None for glass that bends light.
std::optional<MaterialReflectance> reflectance_of(const Scene& scene, const Material& material);

/// Scales the diffuse colour of an opaque material so that it reflects that fraction, together with
/// what textures vary; a black one becomes grey. A mirror's colour is scaled as a whole.
///   fraction   from 0 to 1; of panes, that of all their surface
/// Returns false where that cannot be: glass that bends light, a lobe that alone reflects more
/// already, or a colour that would exceed 1 in a channel.
bool set_reflectance(Scene& scene, Material& material, double fraction);

}  // namespace photile::scene
