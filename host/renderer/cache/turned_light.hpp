// The light of a plane that is turned from the surface that it lies on.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "photile/scene.hpp"

namespace photile::cache {

/// Irradiance of a plane of unit normal n, in the colour of that of the surface.
///   by_normal   as Estimates has it
inline glm::vec3 turned(const glm::vec3& irradiance, const glm::vec4& by_normal,
                        const glm::vec3& normal) {
  const auto light = static_cast<float>(luminance(glm::dvec3(irradiance)));
  if (!(light > 0.0f)) return glm::vec3(0.0f);
  return std::max(0.0f, glm::dot(glm::vec3(by_normal), normal) + by_normal.w) / light * irradiance;
}

}  // namespace photile::cache
