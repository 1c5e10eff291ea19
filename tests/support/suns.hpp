// Suns of scenes that are built in code.
#pragma once

#include "test_scenes.hpp"

namespace photile::test {

/// Of 1 lm. Its light is parallel, or comes from a disc of so many radians.
inline Light sun_along(const glm::vec3& direction, float diameter = 0,
                       const std::string& name = "sun") {
  Light sun = point_light(name, {});
  sun.kind = LightKind::directional;
  sun.direction = direction;
  sun.angular_diameter = diameter;
  return sun;
}

}  // namespace photile::test
