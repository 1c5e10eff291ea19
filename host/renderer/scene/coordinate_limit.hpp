// Which positions a scene can hold.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "photile/limits.hpp"

namespace photile::scene {

/// Neither NaN, infinite nor beyond limits::max_coordinate.
inline bool within_limit(const glm::dvec3& position) {
  constexpr double most = limits::max_coordinate;
  return std::abs(position.x) <= most && std::abs(position.y) <= most &&
         std::abs(position.z) <= most;
}

}  // namespace photile::scene
