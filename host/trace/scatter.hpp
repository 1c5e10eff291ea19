// What happens to a ray at a surface.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The ray that goes on.
struct Scattered {
  glm::vec3 direction;  ///< unit
  glm::vec3 weight;     ///< multiplies the photon's flux or the eye ray's throughput
};

/// Words of the RandomBlock of one interaction.
enum ScatterWord : int { choice_word = 0, direction_word = 1, roulette_word = 3 };

/// Reflection and refraction at a mirror or glass; `choice` in [0, 1) picks one of them with the
/// probability that Fresnel's equations give it. Also used for rays from the eye: the radiance
/// scaling by the squared index of refraction is left out, since it cancels where camera and
/// surface are both in air.
Scattered scatter_specular(const Scene& scene, const SurfacePoint& point,
                           const glm::vec3& direction, float choice);

/// A photon scattered by an opaque surface, as OpaqueBsdf samples it, weighted by the density of
/// both lobes. Nothing where it would enter the surface.
std::optional<Scattered> scatter_opaque(const Scene& scene, const SurfacePoint& point,
                                        const glm::vec3& direction, const RandomBlock& random);

/// Share of light that a pane of thin glass lets through, per channel. `cosine` in [0, 1] to its
/// normal.
glm::vec3 pane_transmittance(const Material& material, float cosine);

/// Reflectance of unpolarised light at a smooth boundary. `cos_i` in [0, 1] on the side that the
/// ray comes from, `eta` the index there over the index beyond. 1 under total internal reflection.
float fresnel_dielectric(float cos_i, float eta);

}  // namespace photile::trace
