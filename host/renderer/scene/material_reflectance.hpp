// How much of the light that falls on it a material reflects.
#pragma once

#include <optional>

#include "photile/scene.hpp"
#include "scene/surface_models.hpp"

namespace photile::scene {

/// The share of light from all directions that an opaque surface sends back, per channel: the
/// reflectance of lighting tables. Within 2% of what the BSDF scatters, by the fits of its albedo.
glm::dvec3 hemispherical_reflectance(const Reflectance& surface);

/// What lighting design calls a material's reflectance: luminous, for light from all directions.
struct MaterialReflectance {
  double whole = 0;
  double matt = 0;  ///< of the diffuse colour alone, as the file has it
};

/// With a texture for the mean of its texels, each of the same weight. None for glass.
std::optional<MaterialReflectance> reflectance_of(const Scene& scene, const Material& material);

/// Scales the diffuse colour of an opaque material so that it reflects that share, and with it what
/// varies by textures; a black one becomes grey. A mirror's colour is scaled as a whole.
///   share   from 0 to 1
/// Returns false where that cannot be: glass, a lobe or texels that reflect more alone, or a colour
/// that would exceed 1 in a channel.
bool set_reflectance(Scene& scene, Material& material, double share);

}  // namespace photile::scene
