#include "measuring/rooms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <utility>

#include "common/foreign_text.hpp"
#include "common/json_object.hpp"
#include "measuring/floor.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"

namespace photile::measuring {
namespace {

using nlohmann::json;

constexpr double above_floor = 0.01;  // metres at which a room's size is taken
constexpr double least_area = 1;      // m2: what is smaller is within a wall
constexpr std::uint32_t most_cameras = 16, most_rooms = 100;

/// m2, negative where the corners of a ring follow clockwise, as those of holes do.
double area_of(const std::vector<glm::dvec2>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2;
}

/// A tenth of a millimetre is as exact as scenes are.
double rounded(double metres) { return std::round(1e4 * metres) / 1e4; }

json components(const glm::dvec3& p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

std::optional<NamedRoom> named(const RayScene& rays, const trace::PlanAxes& axes,
                               const trace::Room& room, const std::string& name) {
  const Scene& scene = rays.scene();
  const Floor floor = find_floor(rays, axes, &room);
  if (floor.triangles.empty()) return std::nullopt;
  const RoomAtHeight plan(rays, axes, room, floor.height + above_floor);
  const glm::dvec2 sides = plan.high() - plan.low();
  auto outlines = plan.outlines();
  std::ranges::stable_sort(outlines, std::greater(), area_of);  // the border first
  double area = 0;
  json rings = json::array();
  for (const auto& ring : outlines) {
    area += area_of(ring);
    json& corners = rings.emplace_back(json::array());
    for (const glm::dvec2& corner : ring) {
      corners.push_back(components(position_in_world(
          scene, corner.x * axes.right + corner.y * axes.ahead + floor.height * axes.up)));
    }
  }
  if (!(area > 0)) return std::nullopt;
  const std::vector<glm::dvec3> places = room.positions();
  const glm::dvec3 middle = std::reduce(places.begin(), places.end()) / double(places.size());
  const glm::dvec3 high = *std::ranges::min_element(
      places, {}, [&](const glm::dvec3& place) { return glm::distance(place, middle); });
  const auto below = trace::intersect(rays, glm::vec3(high), glm::vec3(-axes.up));
  const glm::dvec3 low = below ? trace::position_of(scene, *below) : high;
  const glm::dvec3 inside = position_in_world(scene, 0.5 * (low + high));
  return NamedRoom{name,
                   inside,
                   {{"name", name},
                    {"area", rounded(area)},
                    {"height", rounded(ceiling_height(rays, axes, room) - floor.height)},
                    {"floor", rounded(floor.height + glm::dot(scene.origin, axes.up))},
                    {"sides", {rounded(sides.x), rounded(sides.y)}},
                    {"inside", components(inside)},
                    {"outline", rings.front()},
                    {"holes", json(rings.begin() + 1, rings.end())}}};
}

/// Whether a point of the file's world is between the floor and the ceiling of a room.
bool holds(const NamedRoom& room, const trace::PlanAxes& world, const glm::dvec3& point) {
  const json& ring = room.facts["outline"];
  const auto corner = [&](std::size_t i) {
    const json& p = ring[i % ring.size()];
    return world.plan(glm::dvec3(p[0], p[1], p[2]) - point);
  };
  const double above = glm::dot(point, world.up) - room.facts["floor"].get<double>();
  bool within = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 a = corner(i), b = corner(i + 1);
    if ((a.y > 0) != (b.y > 0) && a.x + a.y / (a.y - b.y) * (b.x - a.x) > 0) within = !within;
  }
  return within && above > 0 && above < room.facts["height"].get<double>();
}

std::vector<NamedRoom> found_rooms(const Scene& scene) {
  std::vector<NamedRoom> all;
  if (scene.triangle_count() == 0) return all;
  const trace::PlanAxes axes, world = trace::PlanAxes::in_world(scene);
  const RayScene rays(scene);
  const auto add = [&](const std::optional<trace::Room>& room) {
    auto found = room ? named(rays, axes, *room, "") : std::nullopt;
    const auto is_same = [&](const NamedRoom& other) {
      return holds(other, world, found->inside) || holds(*found, world, other.inside);
    };
    if (found && found->facts["area"] > least_area && std::ranges::none_of(all, is_same))
      all.push_back(*std::move(found));
    return room.has_value();
  };
  for (std::size_t i = 0; i < scene.cameras.size() && i < most_cameras; ++i) {
    add(trace::Room::of_camera(rays, axes, scene.cameras[i]));
  }
  std::uint32_t tries = 0;
  for (const glm::dvec3& place : places_in_rooms(rays, axes)) {
    const glm::dvec3 there = position_in_world(scene, place);
    const auto has_place = [&](const NamedRoom& room) { return holds(room, world, there); };
    if (std::any_of(all.begin(), all.end(), has_place)) continue;
    // A search that finds nothing may have been a long one: ten of them end it.
    tries += add(trace::Room::around(rays, axes, place)) ? 1 : most_rooms / 10;
    if (tries >= most_rooms) break;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].facts["name"] = all[i].name = fmt::format("room {}", i + 1);
  }
  return all;
}

}  // namespace

std::optional<NamedRoom> room_at(const Scene& scene, const std::optional<glm::dvec3>& inside) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const auto room = trace::Room::meant(rays, axes, inside);
  return room ? named(rays, axes, *room, "") : std::nullopt;
}

std::vector<NamedRoom> rooms_of(const Scene& scene) {
  std::filesystem::path file = scene.source;
  if (!std::filesystem::exists(file.replace_extension(".rooms.json"))) return found_rooms(scene);
  std::vector<NamedRoom> rooms;
  for (const json listed = read_input_json(file); const json& entry : listed) {
    const JsonObject room(
        entry, fmt::format("{}: room {}", file.string(), rooms.size() + 1),
        {"name", "number", "long_name", "storey", "area", "height", "floor", "inside", "wall_band",
         "outline", "holes", "plan", "required_illuminance", "global_id", "observers"});
    room.metres("area");
    room.metres("height");
    room.number("floor", -limits::max_coordinate, limits::max_coordinate);
    rooms.push_back({room.text("name", ""), room.vector("inside"), entry});
  }
  return rooms;
}

std::vector<NamedRoom> rooms_named(const Scene& scene, const std::string& glob) {
  std::vector<NamedRoom> rooms = rooms_of(scene);
  std::vector<std::string> names;
  for (const NamedRoom& room : rooms) names.push_back(one_line(room.name));
  std::erase_if(rooms, [&](const NamedRoom& room) {
    return ::fnmatch(glob.c_str(), room.name.c_str(), 0) != 0;
  });
  if (rooms.empty()) {
    if (names.empty()) names.emplace_back("none");
    throw UsageError(fmt::format("{}: no room has such a name; there are: {}", one_line(glob),
                                 fmt::join(names, ", ")));
  }
  return rooms;
}

}  // namespace photile::measuring
