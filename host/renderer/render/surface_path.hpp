// One path of the path tracer: from a point of an opaque surface towards the light that it
// receives.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "trace/light_sampler.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"

namespace photile::reference {

/// What one light gives to the point where a path starts, that light's layer at power 1.
struct PathLight {
  std::uint32_t layer;
  glm::vec3 irradiance;  ///< W/m2 or lm/m2
  glm::vec3 radiance;    ///< reflected against the ray that arrived, W/(m2 sr) or cd/m2
};

/// Traces one path and appends what it finds, in its order: an unbiased sample of irradiance and
/// reflected radiance (Kajiya, "The rendering equation", 1986). At each surface point a light is
/// sampled and a direction is followed; where both can find the same light, the power heuristic
/// weighs them (Veach and Guibas, "Optimally combining sampling techniques for Monte Carlo
/// rendering", 1995). Paths end by Russian roulette alone.
///   start   on an opaque surface
///   bsdf    there, of the light that leaves against the ray that arrived
void trace_surface_path(const RayScene& rays, const trace::LightSampler& lights,
                        const trace::SurfacePoint& start, const trace::OpaqueBsdf& bsdf,
                        const trace::RandomStream& random, std::vector<PathLight>& found);

}  // namespace photile::reference
