#include "trace/room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "photile/errors.hpp"
#include "trace/ray_query.hpp"

namespace photile::trace {
namespace {

constexpr double cells_of_height = 25;  // side of a cell: 0.1 m in a room of 2.5 m
constexpr double cut_fraction = 0.9;    // of the way from the point up to its ceiling
constexpr std::size_t most_cells = 1u << 20;
constexpr int samples_ahead = 64;      // along a camera's middle ray
constexpr double border_slack = 0.01;  // of a cell: a wall belongs to the room before it

constexpr std::array<glm::i32vec2, 4> steps{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// Metres to the nearest surface; none where there is no surface, or the point is not finite.
std::optional<double> distance_to(const RayScene& rays, const glm::dvec3& from,
                                  const glm::dvec3& direction) {
  const glm::vec3 ray(direction);
  const auto hit = trace::intersect(rays, glm::vec3(from), ray);
  if (!hit) return std::nullopt;
  const glm::dvec3 point(trace::surface_hit(rays.scene(), *hit, ray).position);
  return glm::dot(point - from, direction);
}

std::uint64_t key_of(const glm::i32vec2& cell) {
  return std::uint64_t{static_cast<std::uint32_t>(cell.x)} << 32 |
         static_cast<std::uint32_t>(cell.y);
}

/// Metres up to the ceiling and down to what is below.
struct Headroom {
  double up, down;
};

std::optional<Headroom> headroom_at(const RayScene& rays, const PlanAxes& axes,
                                    const glm::dvec3& point) {
  const auto up = distance_to(rays, point, axes.up), down = distance_to(rays, point, -axes.up);
  if (!up || !down || *up > Room::most_height || *down > Room::most_height) return std::nullopt;
  return Headroom{*up, *down};
}

}  // namespace

PlanAxes PlanAxes::in_world(const Scene& scene) {
  const PlanAxes own;
  return {direction_in_world(scene, own.right), direction_in_world(scene, own.ahead),
          direction_in_world(scene, own.up)};
}

Room::Room(const RayScene& rays, const PlanAxes& axes, const glm::dvec3& seed, double cell)
    : rays_(&rays),
      axes_(axes),
      seed_(seed),
      cell_(cell),
      low_(axes.plan(seed)),
      high_(axes.plan(seed)) {}

std::optional<Room> Room::around(const RayScene& rays, const PlanAxes& axes,
                                 const glm::dvec3& point) {
  const trace::FlushDenormals flush_denormals;
  const auto own = headroom_at(rays, axes, point);
  if (!own) return std::nullopt;
  // What hangs right above the point, such as a luminaire, is not the ceiling, nor is the one above
  // a stairwell beside it: the middle of what is above the point and above those around it.
  struct Position {
    glm::dvec3 point;
    Headroom headroom;
  };
  std::vector<Position> positions{{point, *own}};
  const double aside = 0.2 * (own->up + own->down);
  for (const auto& step : steps) {
    const glm::dvec3 direction =
        static_cast<double>(step.x) * axes.right + static_cast<double>(step.y) * axes.ahead;
    const glm::dvec3 other = point + aside * direction, beyond = other + 0.5 * aside * direction;
    // A point on a wall, or in a window, is no good one, though nothing may hide it.
    if (trace::occluded(rays, glm::vec3(point), glm::vec3(beyond))) continue;
    if (const auto there = headroom_at(rays, axes, other)) positions.push_back({other, *there});
  }
  std::stable_sort(positions.begin(), positions.end(), [](const Position& a, const Position& b) {
    return a.headroom.up < b.headroom.up;
  });
  const auto& [seed, headroom] = positions[positions.size() / 2];
  Room room(rays, axes, seed + cut_fraction * headroom.up * axes.up,
            (headroom.up + headroom.down) / cells_of_height);
  if (!room.spread()) return std::nullopt;
  return room;
}

std::optional<Room> Room::of_camera(const RayScene& rays, const PlanAxes& axes,
                                    const Camera& camera) {
  const trace::FlushDenormals flush_denormals;
  const double seen = distance_to(rays, camera.position, camera.forward).value_or(0);
  for (int i = 0; i < samples_ahead; ++i) {
    const glm::dvec3 point = camera.position + seen * i / samples_ahead * camera.forward;
    if (!headroom_at(rays, axes, point)) continue;
    return around(rays, axes, point);
  }
  return std::nullopt;
}

std::optional<Room> Room::meant(const RayScene& rays, const PlanAxes& axes,
                                const std::optional<glm::dvec3>& inside) {
  const Scene& scene = rays.scene();
  if (!inside) {
    if (scene.cameras.empty()) return std::nullopt;
    return of_camera(rays, axes, scene.cameras.front());
  }
  std::optional<Room> room = around(rays, axes, position_in_scene(scene, *inside));
  if (!room) {
    throw UsageError(
        fmt::format("point {},{},{}: is in no room with a floor below and a ceiling above, each "
                    "less than {} m away; give another point",
                    inside->x, inside->y, inside->z, most_height));
  }
  return room;
}

/// Fills the plan cell by cell. False where the room has no end.
bool Room::spread() {
  std::vector<Cell> next{Cell(0)};
  reached_.insert(key_of(next.back()));
  const auto widen = [&](const glm::dvec3& point) {
    low_ = glm::min(low_, axes_.plan(point));
    high_ = glm::max(high_, axes_.plan(point));
  };
  while (!next.empty()) {
    const Cell cell = next.back();
    next.pop_back();
    const glm::dvec3 from = middle_of(cell);
    for (const Cell& step : steps) {
      const Cell to = cell + step;
      const glm::dvec3 direction =
          static_cast<double>(step.x) * axes_.right + static_cast<double>(step.y) * axes_.ahead;
      const auto wall = distance_to(*rays_, from, direction);
      if (wall && *wall <= cell_) {
        widen(from + *wall * direction);
        continue;
      }
      if (reached(to)) continue;
      const auto ceiling = distance_to(*rays_, middle_of(to), axes_.up);
      if (!ceiling || *ceiling > most_height) {
        widen(from + 0.5 * cell_ * direction);  // the roof ends between the two
        continue;
      }
      if (reached_.size() == most_cells) return false;
      reached_.insert(key_of(to));
      next.push_back(to);
    }
  }
  return true;
}

glm::dvec3 Room::middle_of(const Cell& cell) const {
  return seed_ + cell_ * (static_cast<double>(cell.x) * axes_.right +
                          static_cast<double>(cell.y) * axes_.ahead);
}

bool Room::reached(const Cell& cell) const { return reached_.contains(key_of(cell)); }

bool Room::holds(const glm::dvec2& plan) const {
  const glm::dvec2 offset = plan - axes_.plan(seed_);
  const glm::dvec3 point = seed_ + offset.x * axes_.right + offset.y * axes_.ahead;
  const Cell nearest(glm::round(offset / cell_));
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const Cell cell = nearest + Cell(x, y);
      if (!reached(cell)) continue;
      const glm::dvec3 from = middle_of(cell), way = point - from;
      const double length = glm::length(way);
      const double fraction = length > 0 ? std::max(0.0, 1 - border_slack * cell_ / length) : 0;
      if (!trace::occluded(*rays_, glm::vec3(from), glm::vec3(from + fraction * way))) return true;
    }
  }
  return false;
}

std::vector<glm::dvec3> Room::positions() const {
  std::vector<glm::dvec3> all;
  for (const std::uint64_t key : reached_) {
    all.push_back(middle_of(
        Cell(static_cast<std::int32_t>(key >> 32), static_cast<std::int32_t>(key & 0xffffffffu))));
  }
  return all;
}

}  // namespace photile::trace
