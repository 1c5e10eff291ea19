#include "trace/opaque_bsdf.hpp"
#include "trace/scatter.hpp"

namespace photile::trace {

std::optional<Scattered> scatter_opaque(const Scene& scene, const SurfacePoint& point,
                                        const glm::vec3& direction, const RandomBlock& random) {
  const OpaqueBsdf bsdf(scene, point, direction, PathStart::light);
  const std::optional<glm::vec3> scattered = bsdf.sample(random);
  if (!scattered) return std::nullopt;
  if (!bsdf.glossy()) return Scattered{*scattered, bsdf.albedo()};  // f x cosine / density, exactly
  // The adjoint of the radiance estimate, which multiplies f by flux per geometric area.
  const float density = bsdf.density(*scattered);
  if (!(density > 0.0f)) return std::nullopt;
  return Scattered{*scattered, bsdf.reflected(*scattered) / density};
}

}  // namespace photile::trace
