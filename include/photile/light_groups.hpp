// Lights that share a layer of the picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile {

/// What one layer of the picture holds: a light, or all lights of a group at their powers. Its
/// power scales them together.
struct LightGroup {
  std::string name;                   ///< of the group, or of the light alone
  std::vector<std::uint32_t> lights;  ///< into Scene::lights, ascending
  double power = 0;                   ///< sum of the lights' powers, in Scene::unit
  glm::vec3 color{0.0f};              ///< of their light together; luminance 1
};

/// The layers of a scene and what each light gives to its own.
struct LightGroups {
  std::vector<LightGroup> groups;       ///< in the order of their first lights
  std::vector<std::uint32_t> group_of;  ///< per light
  /// Per light: its part of its group's power; exactly 1 for a light alone. Lights of a group that
  /// is off share equally.
  std::vector<double> share;
};

/// Lights with the same non-empty Light::group share a layer; every other light has its own.
LightGroups light_groups_of(const Scene& scene);

}  // namespace photile
