// The axes of a lamp in the scene.
#pragma once

#include <glm/glm.hpp>

#include "photile/scene.hpp"

namespace photile::trace {

/// A lamp shines along the -z axis of its own space.
struct LampAxes {
  explicit LampAxes(const Light& light)
      : x(light.x_axis), z(-glm::dvec3(light.direction)), y(glm::cross(z, x)) {}

  glm::dvec3 to_world(const glm::dvec3& v) const { return x * v.x + y * v.y + z * v.z; }
  glm::dvec3 to_lamp(const glm::dvec3& v) const {
    return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
  }

  glm::dvec3 x, z, y;  ///< unit; y needs the others
};

}  // namespace photile::trace
