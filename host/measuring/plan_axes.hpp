// Axes of a plan.
#pragma once

#include <glm/glm.hpp>

namespace photile::measuring {

/// `right` x `ahead` = `up`, unit.
struct PlanAxes {
  glm::dvec3 right, ahead, up;

  /// As a map is drawn where `axis` (0, 1, 2) points up; for 1, as in glTF, -z is at its top.
  static PlanAxes of(int axis);
  glm::dvec2 plan(const glm::dvec3& point) const {
    return {glm::dot(point, right), glm::dot(point, ahead)};
  }
};

}  // namespace photile::measuring
