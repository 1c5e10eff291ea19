// Rays from one point in nearly one direction, sixteen at a time.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "photile/ray_scene.hpp"

namespace photile::trace {

/// Rays that are traced together: four times as fast as one by one where they are coherent.
inline constexpr int coherent_rays = 16;

struct CoherentDirections {
  alignas(64) std::array<float, coherent_rays> x, y, z;  ///< unit
};

struct CoherentHits {
  std::array<std::uint32_t, coherent_rays> triangle;  ///< none where nothing is hit
  std::array<std::uint32_t, coherent_rays> side;      ///< at which the ray arrives
  std::array<float, coherent_rays> u, v;              ///< as in TriangleHit;
  std::array<float, coherent_rays> distance;          ///< metres
};

/// The nearest hit of each ray. It is as robust as single rays: none slips between two triangles.
/// Thread-safe; the caller's thread must flush denormals (ray_query.hpp). Directions must be
/// finite.
void intersect(const RayScene& rays, const glm::vec3& origin, const CoherentDirections& directions,
               CoherentHits& hits);

}  // namespace photile::trace
