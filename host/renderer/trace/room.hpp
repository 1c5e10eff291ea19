// The axes of a plan, and the room around a point as far as a plan of its floor needs it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <unordered_set>
#include <vector>

#include "photile/camera.hpp"
#include "photile/ray_scene.hpp"

namespace photile::trace {

/// `right` x `ahead` = `up`, unit. In a scene y points up, and -z is at the top of its map.
struct PlanAxes {
  glm::dvec3 right{1.0, 0.0, 0.0}, ahead{0.0, 0.0, -1.0}, up{0.0, 1.0, 0.0};

  /// The axes in the world of the scene's file.
  static PlanAxes in_world(const Scene& scene);
  glm::dvec2 plan(const glm::dvec3& point) const {
    return {glm::dot(point, right), glm::dot(point, ahead)};
  }
};

/// What can be reached from a point below its ceiling without a wall between, in a horizontal cut
/// not far below that ceiling: walls reach up there above doors and windows, and furniture seldom
/// does. Whatever has no ceiling is outside. Lengths are metres in the scene's coordinates.
class Room {
 public:
  static constexpr double most_height = 20;  ///< metres from a floor to its ceiling

  /// The room around a point; nothing where no surface is above it or none below it, each less than
  /// most_height away, or where the room has no end. The rays are kept.
  static std::optional<Room> around(const RayScene& rays, const PlanAxes& axes,
                                    const glm::dvec3& point);
  /// The room in which a camera stands, or the first that its middle ray reaches.
  static std::optional<Room> of_camera(const RayScene& rays, const PlanAxes& axes,
                                       const Camera& camera);

  /// The room around `inside` (metres in the file's world), or without it that of the scene's first
  /// camera (of_camera). None: the camera reaches no room. Errors: UsageError for a point in no
  /// room.
  static std::optional<Room> meant(const RayScene& rays, const PlanAxes& axes,
                                   const std::optional<glm::dvec3>& inside);

  /// Corners of the upright rectangle around its plan.
  const glm::dvec2& low() const { return low_; }
  const glm::dvec2& high() const { return high_; }
  bool holds(const glm::dvec2& plan) const;

  /// Points in the cut, spread evenly: one for each `cell_area`.
  std::vector<glm::dvec3> positions() const;
  double cell_area() const { return cell_ * cell_; }
  /// The height of the cut along `up`, metres: just below the ceiling.
  double cut_height() const { return glm::dot(seed_, axes_.up); }

 private:
  using Cell = glm::i32vec2;

  Room(const RayScene& rays, const PlanAxes& axes, const glm::dvec3& seed, double cell);
  bool spread();
  glm::dvec3 middle_of(const Cell& cell) const;
  bool reached(const Cell& cell) const;

  const RayScene* rays_;
  PlanAxes axes_;
  glm::dvec3 seed_;  ///< in the cut
  double cell_;      ///< metres
  std::unordered_set<std::uint64_t> reached_;
  glm::dvec2 low_, high_;
};

}  // namespace photile::trace
