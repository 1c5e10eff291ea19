// Rays through the holes of cut-out materials (Material::opacity).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "photile/ray_scene.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Whether a ray passes the surface here as if it were not there: always in a hole, never where the
/// surface is whole, by chance where it is partly there. Behind 4096 holes of a path all surfaces
/// count as whole.
///   holes   passed so far on the path; counts on
bool passes_hole(const Scene& scene, const SurfacePoint& point, const RandomStream& random,
                 Purpose purpose, std::uint32_t& holes);

/// Where a ray meets a surface that it does not pass, or nothing. `origin` moves behind the last
/// hole.
std::optional<SurfacePoint> next_surface(const RayScene::Impl& rays, glm::vec3& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& holes);
std::optional<SurfacePoint> next_surface(const RayScene& rays, glm::vec3& origin,
                                         const glm::vec3& direction, const RandomStream& random,
                                         Purpose purpose, std::uint32_t& holes);

}  // namespace photile::trace
