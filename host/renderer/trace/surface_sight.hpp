// Lines of sight between places of one surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::trace {

struct SurfacePlace {
  glm::vec3 position;  ///< metres
  glm::vec3 normal;    ///< unit, of the side
};

inline SurfacePlace place_on(const Scene& scene, std::uint32_t sided_triangle,
                             const glm::vec3& position) {
  return {position, glm::vec3(sided_normal(scene, sided_triangle))};
}

/// How a line of sight differs from the straight way between two places.
struct SightLine {
  float lift;      ///< it runs so far above them, metres
  float left_out;  ///< and ends short of the second by this part of its length
};

/// Whether nothing is between two places of one surface, just above it. Where it is curved, a line
/// of sight as deep in it as a circle's chord is lifted out by twice as much.
bool see_each_other(const RayScene& rays, const SurfacePlace& from, const SurfacePlace& to,
                    const SightLine& line);

}  // namespace photile::trace
