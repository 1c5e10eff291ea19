// Where the floor of a room is, and which points over it furniture stands on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/scene.hpp"
#include "trace/room.hpp"

namespace photile::measuring {

/// Triangles of the floor: see working_plane_grid for which they are. Empty where there is none.
struct Floor {
  double height = 0;  ///< along `up`, metres: half of its area is not higher
  std::vector<std::uint32_t> triangles;
};
/// The floor of `room`, or of the whole scene where that is null.
Floor find_floor(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room* room);

/// The floor as seen from above.
class FloorPlan {
 public:
  /// `room` is null or the part of the floor that counts; it is kept.
  FloorPlan(const Scene& scene, const Floor& floor, const trace::PlanAxes& axes,
            const trace::Room* room);

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
  const trace::Room* room_ = nullptr;
};

/// Makes those sensors of a grid blank, and takes the cells of a plane that are theirs:
/// - with a surface nearer than `clearance` metres, along or against their direction, on walls and
/// ceilings
///   along it; 0 = none;
/// - inside a solid, or beyond the walls that most of the grid stands within: of six rays, along
/// and across their direction, at least five cross an odd number
///   of surfaces where the same ray of most sensors of the grid crosses an even one, or the other
///   way round. Whichever way a closed mesh is wound, a ray from inside leaves it once more than it
///   enters it; a single sheet, such as a pane, turns no more than one or two of the rays.
/// Returns how many.
std::size_t leave_out_furniture(const Scene& scene, double clearance, SensorGrid& grid);

}  // namespace photile::measuring
