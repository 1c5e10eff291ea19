// A shading point: the surface at a hit, and its weights for the arriving light.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>

#include "photile/device/bsdf.h"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/random_stream.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The point of its surface where a hit lies.
inline SurfacePoint point_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit) {
  return surface_point(scene, hits.oriented_face[hit], hits.position[hit]);
}

/// How the surface reflects light against the ray of an eye that arrived there, smoothly shaded. A
/// Lambertian surface looks the same from everywhere: where nothing is glossy, hits do not store
/// the direction, and any direction may be used.
inline OpaqueBsdf bsdf_of(const Scene& scene, const PrimaryHits& hits, std::size_t hit,
                          const SurfacePoint& point) {
  OpaqueBsdf bsdf(scene, point, hits.outgoing.empty() ? -point.normal : -hits.outgoing[hit]);
  bsdf.shade_smoothly(scene, point);
  // Hits that are seen directly, where only reflections count.
  if (hits.diffuse_albedo[hit] == glm::vec3(0.0f)) bsdf.drop_diffuse();
  return bsdf;
}

/// The weights of light for the two quantities measured at a shading point.
struct LightWeights {
  glm::vec3 irradiance{1.0f};
  glm::vec3 radiance{1.0f};  ///< reflected

  friend LightWeights operator*(const LightWeights& a, const glm::vec3& b) {
    return {a.irradiance * b, a.radiance * b};
  }
};

/// Weights light by its cosine and by its reflection, and draws directions for both: on a glossy
/// surface half of them follow the cosine, because a narrow lobe would find almost none of the
/// irradiance. References are kept.
class ShadingPoint {
 public:
  ShadingPoint(const SurfacePoint& point, const OpaqueBsdf& bsdf) : point_(point), bsdf_(bsdf) {}

  /// The weights of light from `direction` (unit, away from the surface), per steradian.
  LightWeights weights(const glm::vec3& direction) const {
    return {glm::vec3(cosine(direction)), bsdf_.reflected(direction)};
  }

  /// A direction, or nothing where it would enter the surface.
  ///   choice, random   separate blocks
  std::optional<glm::vec3> sample(const RandomBlock& choice, const RandomBlock& random) const {
    if (bsdf_.lambertian() || choice.bit(0)) return bsdf_.sample(random);
    return Frame(point_.normal)
        .to_world(sample_cosine_hemisphere(random.uniform(direction_word),
                                           random.uniform(direction_word + 1)));
  }

  /// Density of such directions per steradian.
  float density(const glm::vec3& direction) const {
    if (bsdf_.lambertian()) return bsdf_.density(direction);
    return 0.5f * (bsdf_.density(direction) + cosine(direction) / PHOTILE_PI);
  }

 private:
  float cosine(const glm::vec3& direction) const {
    return std::max(0.0f, glm::dot(direction, point_.normal));
  }

  const SurfacePoint& point_;
  const OpaqueBsdf& bsdf_;
};

}  // namespace photile::trace
