// What lights emit, from what people know of them.
#pragma once

#include <string>

#include "photile/scene.hpp"

namespace photile::scene {

/// `light.color` and the luminance of `rgb`, which may be any radiometric colour; false if black.
bool set_light_color(const glm::dvec3& rgb, Light& light, double& luminance_of_rgb);

/// Colour and power of an area light whose emission texture has white texels of radiance
/// `texel_radiance`, per triangle of `light.triangles`; scales that radiance to power 1. False if
/// black.
bool set_textured_emission(const Scene& scene, Light& light);

/// Flux of a directional light through a disc of `radius` metres that faces it, where a surface
/// that faces it gets `irradiance`; `angular_diameter` of its disc in radians.
double distant_flux(double irradiance, double angular_diameter, double radius);

/// Adds a light that is a map of all that surrounds the scene, which must have its triangles.
void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene);

}  // namespace photile::scene
