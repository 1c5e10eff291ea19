// Where the floor of a room is, and how far the room reaches at a height above it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <utility>
#include <vector>

#include "photile/scene.hpp"
#include "trace/room.hpp"

namespace photile::measuring {

/// Metres that are free above a floor.
inline constexpr double least_room = 1.2;

/// Triangles of the floor: see working_plane_grid for which they are. Empty where there is none.
struct Floor {
  double height = 0;  ///< along `up`, metres: half of its area is not higher
  std::vector<std::uint32_t> triangles;
};
/// The floor of `room`, or of the whole scene where that is null.
Floor find_floor(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room* room);

/// The height along `up` that most of the ceiling has over the room's cut, metres.
double ceiling_height(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room& room);

/// What a horizontal plane has of a room: all below the room's cut, and what sloped ceilings cover
/// beside that, down to the plane. There the cut follows them, a tenth of the room's height below.
class RoomAtHeight {
 public:
  ///   height   along `up`, metres
  /// The rays are kept.
  RoomAtHeight(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room& room,
               double height);

  /// Corners of the upright rectangle around it.
  const glm::dvec2& low() const { return low_; }
  const glm::dvec2& high() const { return high_; }
  bool holds(const glm::dvec2& plan) const;
  /// The corners of its plan: of its border counterclockwise, of holes in it clockwise.
  std::vector<std::vector<glm::dvec2>> outlines() const;

 private:
  using Cell = std::pair<int, int>;  ///< columns to the right, rows ahead

  glm::dvec3 middle_of(const Cell& cell, double height) const;
  glm::dvec2 border_of(const Cell& cell, const Cell& side) const;

  const RayScene* rays_;
  trace::PlanAxes axes_;
  glm::dvec2 first_;              ///< the middle of the cell {0, 0}
  double side_;                   ///< of a cell, metres
  std::map<Cell, double> cells_;  ///< the height of the cut in each
  glm::dvec2 low_, high_;
};

/// Places at half the height of rooms with walls all around; what is within walls and furniture is
/// left out.
std::vector<glm::dvec3> places_in_rooms(const RayScene& rays, const trace::PlanAxes& axes);

/// The floor as seen from above.
class FloorPlan {
 public:
  /// `room` is null or the part of the floor that counts; it is kept.
  FloorPlan(const Scene& scene, const Floor& floor, const trace::PlanAxes& axes,
            const RoomAtHeight* room);

  const glm::dvec2& low() const { return low_; }
  const glm::dvec2& high() const { return high_; }
  /// Whether the disc lies on the floor, up to about 1/1000 of the floor's width.
  bool holds_disc(const glm::dvec2& middle, double radius) const;

 private:
  bool holds(const glm::dvec2& point) const;
  void fill(const std::array<glm::dvec2, 3>& corners);

  glm::dvec2 low_{0.0}, high_{0.0};
  double pixel_ = 1;  ///< metres
  int width_ = 0, height_ = 0;
  std::vector<bool> covered_;  ///< width x height
  const RoomAtHeight* room_ = nullptr;
};

}  // namespace photile::measuring
