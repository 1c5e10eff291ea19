#include "measuring/working_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/ascii_text.hpp"
#include "measuring/floor.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::measuring {
namespace {

int cells_along(double metres, double spacing) {
  return static_cast<int>(std::clamp(std::round(metres / spacing), 1.0, 1e6));
}

}  // namespace

WorkingPlane parse_working_plane(const std::string& text) {
  WorkingPlane plane;
  std::string_view height = text;
  plane.above_floor = height.starts_with("floor");
  if (plane.above_floor) height.remove_prefix(5);
  if (plane.above_floor && height.empty()) return plane;
  const bool plus = height.starts_with('+');
  if (plus) height.remove_prefix(1);
  const auto metres = parse_number<double>(height);
  if (!metres || std::abs(*metres) > limits::max_coordinate || (plane.above_floor && !plus)) {
    throw UsageError(fmt::format(
        "working plane {}: is no height; write floor+0.75, or metres in the scene's world", text));
  }
  plane.height = *metres;
  return plane;
}

SensorGrid working_plane_grid(const Scene& scene, const WorkingPlane& plane) {
  const PlanAxes axes;
  const RayScene rays(scene);
  const std::optional<Room> room = Room::meant(rays, axes, plane.inside);
  const Floor floor = find_floor(rays, axes, room ? &*room : nullptr);
  if (floor.triangles.empty()) {
    throw InputError(fmt::format("{}: no floor found; describe the plane by a grid of points",
                                 scene.source.string()));
  }
  const FloorPlan plan(scene, floor, axes, room ? &*room : nullptr);
  const glm::dvec2 low = plan.low() + plane.wall_band, high = plan.high() - plane.wall_band;
  if (!(high.x > low.x) || !(high.y > low.y)) {
    throw InputError(fmt::format(
        "{}: a wall band of {} m leaves nothing of a floor of {:.2f} x {:.2f} m; make it smaller",
        scene.source.string(), plane.wall_band, plan.high().x - plan.low().x,
        plan.high().y - plan.low().y));
  }
  const glm::dvec2 size = high - low;
  const PointCounts counts = plane.spacing > 0 ? PointCounts{cells_along(size.x, plane.spacing),
                                                             cells_along(size.y, plane.spacing)}
                                               : points_of_en12464(size.x, size.y);
  const double cells = static_cast<double>(counts.columns) * static_cast<double>(counts.rows);
  if (cells > static_cast<double>(limits::max_sensors)) {
    throw UsageError(
        fmt::format("spacing {} m: makes more than {} points", plane.spacing, limits::max_sensors));
  }

  PlaneLayout layout;
  layout.columns = counts.columns;
  layout.rows = counts.rows;
  layout.u = size.x * axes.right;
  layout.v = size.y * axes.ahead;
  const double height = plane.above_floor ? floor.height + plane.height
                                          : plane.height - glm::dot(scene.origin, axes.up);
  layout.origin = low.x * axes.right + low.y * axes.ahead + height * axes.up;
  for (std::uint32_t cell = 0; cell < static_cast<std::uint32_t>(cells); ++cell) {
    if (plan.holds_disc(axes.plan(layout.middle_of(cell)), plane.wall_band)) {
      layout.cells.push_back(cell);
    }
  }
  if (layout.cells.empty()) {
    throw InputError(
        fmt::format("{}: no point of the floor is {} m from its border; make the wall band smaller",
                    scene.source.string(), plane.wall_band));
  }
  SensorGrid grid = grid_on_plane("working plane", in_world(scene, std::move(layout)));
  if (!room) {
    grid.remark =
        "the camera comes to no room with a ceiling: this is the widest floor of the scene; name a "
        "point in the room by --inside X,Y,Z";
  }
  return grid;
}

}  // namespace photile::measuring
