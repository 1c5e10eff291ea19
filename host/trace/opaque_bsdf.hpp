// The BSDF of an opaque surface (device/bsdf.h) at one point, for the ray that arrives there: its
// value, directions drawn from it, and their density.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "trace/random_stream.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Directions are unit and point away from the surface. Cosines are those to the geometric normal,
/// as in the radiance estimate; the lobe turns with the shading normal.
class OpaqueBsdf {
 public:
  /// `direction`: of the ray that arrives at the point, unit.
  OpaqueBsdf(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction);

  bool glossy() const { return lobe_.has_value(); }
  const glm::vec3& albedo() const { return albedo_; }  ///< of the Lambertian lobe

  /// A direction from the Lambertian or the GGX lobe, picked in proportion to estimates of their
  /// albedos. Nothing where it would enter the surface. Uses the words `choice_word`,
  /// `direction_word` and the one after it.
  std::optional<glm::vec3> sample(const RandomBlock& random) const;

  /// Density of such directions per steradian; 0 below the surface.
  float density(const glm::vec3& direction) const;

  /// f x cosine, per steradian; black below the surface.
  glm::vec3 reflected(const glm::vec3& direction) const;

 private:
  struct Lobe {
    Frame frame;       ///< of the shading normal
    float alpha;       ///< GGX
    glm::vec3 view;    ///< against the ray that arrived, in `frame`
    float n_dot_view;  ///< kept above 0
    float share;       ///< of the directions drawn, in [0, 1]
  };
  Lobe lobe_of(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction) const;

  const Material* material_;
  glm::vec3 albedo_;
  glm::vec3 normal_;
  std::optional<Lobe> lobe_;  ///< none where the surface is Lambertian
};

}  // namespace photile::trace
