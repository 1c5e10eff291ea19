#include "measuring/working_plane.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/ascii_text.hpp"
#include "measuring/floor.hpp"
#include "measuring/furniture.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/panes.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"
#include "weather/perez_sky.hpp"

namespace photile::measuring {

namespace {

/// Errors: UsageError where the spacing makes too many points.
PlaneLayout layout_of(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v,
                      const WorkingPlane& plane) {
  const PointCounts counts = points_at(glm::length(u), glm::length(v), plane.spacing);
  if (counts.total() > limits::max_sensors) {
    throw UsageError(
        fmt::format("spacing {} m: makes more than {} points", plane.spacing, limits::max_sensors));
  }
  return full_plane(origin, u, v, counts);
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
        "working plane {} is not a height; write floor+0.75, or metres in the scene's world",
        text));
  }
  plane.height = *metres;
  return plane;
}

SensorGrid working_plane_grid(const Scene& scene, const WorkingPlane& plane) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const std::optional<trace::Room> room = trace::Room::meant(rays, axes, plane.inside);
  const Floor floor = find_floor(rays, axes, room ? &*room : nullptr);
  if (floor.triangles.empty()) {
    throw InputError(fmt::format(
        "{}: no floor found with {} m free above it; give points with --points or --grid",
        scene.source.string(), least_room));
  }
  const double height = plane.above_floor ? floor.height + plane.height
                                          : plane.height - glm::dot(scene.origin, axes.up);
  std::optional<RoomAtHeight> part;
  if (room) part.emplace(rays, axes, *room, height);
  const FloorPlan plan(scene, floor, axes, part ? &*part : nullptr);
  const glm::dvec2 low = plan.low() + plane.wall_band, high = plan.high() - plane.wall_band;
  if (!(high.x > low.x) || !(high.y > low.y)) {
    throw InputError(fmt::format(
        "{}: a wall band of {} m leaves nothing of a floor of {:.2f} x {:.2f} m; make it smaller",
        scene.source.string(), plane.wall_band, plan.high().x - plan.low().x,
        plan.high().y - plan.low().y));
  }
  const glm::dvec2 size = high - low;
  PlaneLayout layout = layout_of(low.x * axes.right + low.y * axes.ahead + height * axes.up,
                                 size.x * axes.right, size.y * axes.ahead, plane);
  std::erase_if(layout.cells, [&](std::uint32_t cell) {
    return !plan.holds_disc(axes.plan(layout.middle_of(cell)), plane.wall_band);
  });
  if (layout.cells.empty()) {
    throw InputError(
        fmt::format("{}: no point of the floor is {} m from its border; make the wall band smaller",
                    scene.source.string(), plane.wall_band));
  }
  SensorGrid grid = grid_on_plane("working plane", in_world(scene, std::move(layout)));
  grid.chosen = true;
  grid.inside = plane.inside;
  if (!room) {
    grid.remark =
        "no room with a ceiling is at the camera or in front of it: the widest floor of the scene "
        "is measured; give a point in the room by --inside X,Y,Z, or the area by --grid FILE";
  }
  return grid;
}

void keep_in_room(const Scene& scene, const glm::dvec3& place, SensorGrid& grid) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const auto room = trace::Room::around(rays, axes, position_in_scene(scene, place));
  if (!room) return;
  PlaneLayout layout = *grid.layout;
  const glm::dvec3 origin = position_in_scene(scene, layout.origin);
  const RoomAtHeight part(rays, axes, *room, glm::dot(origin, axes.up));
  std::erase_if(layout.cells, [&](std::uint32_t cell) {
    return !part.holds(axes.plan(position_in_scene(scene, layout.middle_of(cell))));
  });
  // The rectangle around what is left.
  const auto columns = static_cast<std::uint32_t>(layout.columns);
  glm::uvec2 low(columns, layout.rows), high(0);
  for (const std::uint32_t cell : layout.cells) {
    low = glm::min(low, glm::uvec2(cell % columns, cell / columns));
    high = glm::max(high, glm::uvec2(cell % columns, cell / columns));
  }
  if (!layout.cells.empty()) {
    const glm::uvec2 counts = high - low + 1u;
    const PlaneLayout all = layout;
    layout.columns = static_cast<int>(counts.x);
    layout.rows = static_cast<int>(counts.y);
    layout.origin = all.at(glm::dvec2(low));
    layout.u *= double(counts.x) / all.columns;
    layout.v *= double(counts.y) / all.rows;
    for (std::uint32_t& cell : layout.cells) {
      cell = (cell / columns - low.y) * counts.x + cell % columns - low.x;
    }
  }
  const GridRole role = grid.role;
  grid = grid_on_plane(grid.name, std::move(layout));
  grid.role = role;
}

namespace {

constexpr double before_surface = 1e-3;  // metres that sensors lie before it
constexpr double surface_slack = 0.05;   // metres that a wall may lie before or behind its plane
constexpr double probed_from = 0.3;      // metres before a wall from where it is looked for
constexpr int sides = 4;

/// Metres to the first surface and whether it is glass.
struct Met {
  double distance;
  bool glass;
};

std::optional<Met> met_by(const RayScene& rays, const glm::dvec3& from,
                          const glm::dvec3& direction) {
  const glm::vec3 ray(direction);
  const auto hit = trace::intersect(rays, glm::vec3(from), ray);
  if (!hit) return std::nullopt;
  const trace::SurfacePoint point = trace::surface_hit(rays.scene(), *hit, ray);
  return Met{glm::dot(glm::dvec3(point.position) - from, direction),
             scene::is_glazing(trace::material_of(rays.scene(), point))};
}

trace::Room room_of(const RayScene& rays, const trace::PlanAxes& axes, const WorkingPlane& plane) {
  auto room = trace::Room::meant(rays, axes, plane.inside);
  if (!room) {
    throw InputError(
        fmt::format("{}: no room with a ceiling is at the camera or in front of it, so there are "
                    "no walls; give a point in the room by --inside X,Y,Z",
                    rays.scene().source.string()));
  }
  return *std::move(room);
}

/// The sensors of a plane that lie on a surface, just before it; the others are blank. Coordinates
/// are the scene's, and become the world's.
SensorGrid on_surface(const RayScene& rays, const std::string& name, const PlaneLayout& layout,
                      const WorkingPlane& plane, const char* missing) {
  const trace::FlushDenormals flush_denormals;
  const SensorGrid all = grid_on_plane(name, layout);
  SensorGrid grid{name, {}, layout};
  grid.chosen = true;
  grid.inside = plane.inside;
  grid.layout->cells.clear();
  const Scene& scene = rays.scene();
  for (std::size_t i = 0; i < all.sensors.size(); ++i) {
    const Sensor& sensor = all.sensors[i];
    const auto met = met_by(rays, sensor.position + probed_from * sensor.normal, -sensor.normal);
    const bool there = met && std::abs(met->distance - probed_from) <= surface_slack;
    if (there && !met->glass) {
      const glm::dvec3 place =
          sensor.position + (probed_from - met->distance + before_surface) * sensor.normal;
      grid.sensors.push_back(
          {position_in_world(scene, place), direction_in_world(scene, sensor.normal)});
      grid.layout->cells.push_back(layout.cells[i]);
    } else {
      grid.blanks.push_back(
          {{position_in_world(scene, sensor.position), direction_in_world(scene, sensor.normal)},
           there ? "glass" : missing,
           grid.sensors.size()});
    }
  }
  grid.layout = in_world(scene, std::move(*grid.layout));
  return grid;
}

}  // namespace

std::vector<SensorGrid> wall_grids(const Scene& scene, const WorkingPlane& plane) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const trace::Room room = room_of(rays, axes, plane);
  const double floor = find_floor(rays, axes, &room).height;
  const glm::dvec3 height = (ceiling_height(rays, axes, room) - floor) * axes.up;
  std::vector<SensorGrid> grids;
  for (int side = 0; side < sides; ++side) {
    const double turn = glm::half_pi<double>() * side;
    const glm::dvec2 outwards(std::round(std::sin(turn)), std::round(std::cos(turn)));
    // Seen from within the room the wall runs from left to right.
    const glm::dvec2 along(outwards.y, -outwards.x);
    const glm::dvec2 middle = 0.5 * (room.low() + room.high());
    const glm::dvec2 half = 0.5 * (room.high() - room.low());
    const glm::dvec2 corner = middle + half * (outwards - along);
    const glm::dvec2 width = 2.0 * half * along;
    const auto in_space = [&](const glm::dvec2& p) { return p.x * axes.right + p.y * axes.ahead; };
    SensorGrid grid =
        on_surface(rays, fmt::format("{} wall", weather::compass_point(90 * side - plane.north)),
                   layout_of(in_space(corner) + floor * axes.up, in_space(width), height, plane),
                   plane, "no wall");
    grid.role = GridRole::wall;
    if (!grid.sensors.empty()) grids.push_back(std::move(grid));
  }
  return grids;
}

SensorGrid ceiling_grid(const Scene& scene, const WorkingPlane& plane) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const trace::Room room = room_of(rays, axes, plane);
  const glm::dvec2 size = room.high() - room.low();
  // It faces down: u x v is -up.
  const glm::dvec3 origin = room.low().x * axes.right + room.high().y * axes.ahead +
                            ceiling_height(rays, axes, room) * axes.up;
  SensorGrid grid = on_surface(rays, "ceiling",
                               layout_of(origin, size.x * axes.right, -size.y * axes.ahead, plane),
                               plane, "no ceiling at that height");
  grid.role = GridRole::ceiling;
  return grid;
}

SensorGrid cylindrical_grid(const Scene& scene, const WorkingPlane& plane) {
  SensorGrid grid = working_plane_grid(scene, plane);
  grid.name = "cylindrical";
  grid.role = GridRole::cylindrical;
  for (Sensor& sensor : grid.sensors) sensor.response = SensorResponse::cylindrical;
  return grid;
}

std::vector<SensorGrid> semi_cylindrical_grids(const Scene& scene, const WorkingPlane& plane) {
  const trace::PlanAxes axes = trace::PlanAxes::in_world(scene);
  const SensorGrid over_floor = working_plane_grid(scene, plane);
  std::vector<SensorGrid> grids;
  for (int side = 0; side < sides; ++side) {
    const double turn = glm::half_pi<double>() * side;
    SensorGrid grid = over_floor;
    grid.name =
        fmt::format("semi-cylindrical to the {}", weather::compass_point(90 * side - plane.north));
    grid.role = GridRole::other;
    for (Sensor& sensor : grid.sensors) {
      sensor.response = SensorResponse::semi_cylindrical;
      sensor.facing = std::sin(turn) * axes.right + std::cos(turn) * axes.ahead;
    }
    grids.push_back(std::move(grid));
  }
  return grids;
}

bool Places::empty() const {
  return planes.empty() && points.empty() && plane.empty() && !walls && !ceiling &&
         cylindrical.empty() && semi_cylindrical.empty();
}

std::vector<SensorGrid> grids_at(const Scene& scene, const Places& places, Progress& progress) {
  std::vector<SensorGrid> grids;
  for (const std::string& file : places.planes) {
    glm::dvec3 task(0.0);  // a point above it, off the table
    for (SensorGrid& grid : read_planes(file)) {
      if (grid.role == GridRole::task) {
        task = grid.sensors[grid.sensors.size() / 2].position + 0.05 * grid.layout->normal();
      }
      if (grid.role == GridRole::background) keep_in_room(scene, task, grid);
      if (!grid.sensors.empty()) grids.push_back(std::move(grid));
    }
  }
  for (const std::string& file : places.points) grids.push_back(read_points(file));
  const auto add_room = [&](WorkingPlane layout, const std::string& name) {
    const auto at = [&](const std::string& height) {
      const WorkingPlane level = parse_working_plane(height);
      layout.above_floor = level.above_floor;
      layout.height = level.height;
      return layout;
    };
    const auto add = [&](const auto& make, const WorkingPlane& plane) {
      std::vector<SensorGrid> made;
      try {
        made = make(scene, plane);
      } catch (const InputError& error) {
        if (name.empty()) throw;
        made.emplace_back().remark = error.what();  // other rooms have their grids
      }
      for (SensorGrid& grid : made) grids.push_back(std::move(grid));
    };
    const std::size_t first = grids.size();
    const auto one = [](const auto& make) {
      return [make](const auto&... of) { return std::vector{make(of...)}; };
    };
    if (!places.plane.empty()) add(one(working_plane_grid), at(places.plane));
    const bool has_plane = grids.size() > first;
    if (places.walls) add(wall_grids, at("floor"));
    if (places.ceiling) add(one(ceiling_grid), at("floor"));
    if (!places.cylindrical.empty()) add(one(cylindrical_grid), at(places.cylindrical));
    if (!places.semi_cylindrical.empty()) add(semi_cylindrical_grids, at(places.semi_cylindrical));
    for (std::size_t i = first; !name.empty() && i < grids.size(); ++i) {
      const bool is_main = grids[i].name.empty() || (has_plane && i == first);
      grids[i].name = is_main ? name : name + ": " + grids[i].name;
    }
  };
  WorkingPlane layout = places.layout;
  for (const NamedRoom& room : places.rooms) {
    layout.inside = room.inside;
    add_room(layout, room.name);
  }
  if (places.rooms.empty()) add_room(layout, "");
  clear_of_furniture(scene, places.clearance, !places.rooms.empty(), grids, progress);
  std::size_t sensors = 0;
  for (const SensorGrid& grid : grids) sensors += grid.sensors.size();
  if (sensors == 0 && !places.empty()) {
    throw UsageError("no point is left in any room; give another height, or a narrower wall band");
  }
  if (sensors > limits::max_sensors) {
    throw UsageError(fmt::format("{} points together, more than {}; measure fewer", sensors,
                                 limits::max_sensors));
  }
  return grids;
}

}  // namespace photile::measuring
