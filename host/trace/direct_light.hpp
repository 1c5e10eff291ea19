// Light that reaches a surface straight from lamps, by rays instead of photons.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Light of one layer, whose power is 1, at a receiver.
struct ReceivedLight {
  std::uint32_t layer;   ///< into LightGroups::groups
  glm::vec3 irradiance;  ///< lm/m2
  glm::vec3 radiance;    ///< reflected against the ray that arrived at the receiver
};

/// Estimates what lamps send straight to a point of an opaque surface, or through panes of thin
/// glass and holes of cut-out surfaces: just what photons bring that are not scattered before.
/// `count` times a lamp is looked at, and a direction of the surface's own is followed; what both
/// would find is weighed (Veach and Guibas 1995, power heuristic). The sum over what is appended to
/// `found` is unbiased.
///   direction   of the ray that arrived at the point, unit
///   lobe_only   leaves the diffuse reflection out of the radiance
void find_direct_light(const RayScene& rays, const LightSampler& lamps, const SurfacePoint& point,
                       const glm::vec3& direction, bool lobe_only, int count,
                       const RandomStream& random, std::vector<ReceivedLight>& found);

}  // namespace photile::trace
