// The scattering of a ray at a surface.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The continuing ray.
struct Scattered {
  glm::vec3 direction;  ///< unit
  glm::vec3 weight;     ///< multiplies the photon's flux or the eye ray's throughput
  /// A further factor on the throughput of a ray from the eye: a boundary preserves radiance over
  /// the squared index of refraction, so that radiance seen through one is that beyond it times
  /// (index here / index beyond)^2. The flux that photons carry has no such factor (Veach, "Robust
  /// Monte Carlo methods for light transport simulation", 1997, section 5.2). In double precision:
  /// into a glass and out again it is 1 to the last bit of a float.
  double radiance_factor = 1;
};

/// Words of the RandomBlock of one interaction.
enum ScatterWord : int { choice_word = 0, direction_word = 1, roulette_word = 3 };

/// Reflection and refraction at a mirror or glass; `choice` in [0, 1) picks one of them with the
/// probability that Fresnel's equations give it.
Scattered scatter_specular(const Scene& scene, const SurfacePoint& point,
                           const glm::vec3& direction, float choice);

/// Both ways that light takes at the boundary of glass.
struct SplitLight {
  float reflectance;  ///< fraction of the light that is reflected, in (0, 1)
  Scattered reflected, transmitted;
};

/// Both ways that light takes at a surface. Nothing where there is only one: at mirrors, under
/// total reflection, and where the shading normal would send one of the rays to the wrong side.
std::optional<SplitLight> both_parts(const Scene& scene, const SurfacePoint& point,
                                     const glm::vec3& direction);

/// A photon scattered by an opaque surface, as OpaqueBsdf samples it, weighted by the density of
/// both lobes. Nothing where it would enter the surface.
std::optional<Scattered> scatter_opaque(const Scene& scene, const SurfacePoint& point,
                                        const glm::vec3& direction, const RandomBlock& random);

/// Fraction of light that a pane of thin glass lets through, per channel. `cosine` in [0, 1] to its
/// normal.
glm::vec3 pane_transmittance(const Material& material, float cosine);

/// Reflectance of unpolarised light at a smooth boundary. `cos_i` in [0, 1] on the side that the
/// ray comes from, `eta` the index there over the index beyond. 1 under total internal reflection.
float fresnel_dielectric(float cos_i, float eta);

}  // namespace photile::trace
