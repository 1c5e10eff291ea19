// What the plan of a plane of sensors shows beside their values, so that a reader knows the room:
// walls, furniture and lamps.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/ray_scene.hpp"
#include "report/isolines.hpp"

namespace photile::report {

/// A lamp of the schedule.
struct LampMark {
  std::size_t number;  ///< from 1, that of the scene's light
  glm::dvec2 place;
};

/// Places are counted in the plane's cells, from its corner, and may lie beyond its sides.
struct PlanSurroundings {
  double reach = 0;                ///< metres around the plane that are shown
  std::vector<Segment> walls;      ///< where the plane cuts surfaces
  std::vector<Segment> furniture;  ///< outlines of what stands below the plane
  std::vector<LampMark> lamps;     ///< lights with a place, above or below
};

/// The middle of a lamp's surface, or where it is, in the scene's coordinates; nothing of the sky.
std::optional<glm::dvec3> place_of(const Scene& scene, const Light& light);

/// None but reach 0 for a plane that is not horizontal (y is up).
PlanSurroundings surroundings_of(const RayScene& rays, const measuring::PlaneLayout& layout);

}  // namespace photile::report
