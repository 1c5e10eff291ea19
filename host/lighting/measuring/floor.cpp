#include "measuring/floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <set>
#include <unordered_map>

#include "photile/ray_scene.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::measuring {

namespace {

const double steepest_cosine = std::cos(glm::radians(5.0));
constexpr double level_thickness = 0.02;  // metres
constexpr int most_surfaces_below = 1000;
constexpr double least_share = 0.5;      // of the widest level
constexpr std::uint32_t samples = 8192;  // points whose headroom is looked at
constexpr double plan_pixels = 1024;     // along the longer side
constexpr double below_slope = 2.5;      // cells of a room: a tenth of its height
constexpr double above_plane = 2e-3;     // metres
constexpr double least_width = 0.8;      // metres of a room; walls and cabinets are narrower
constexpr double near_ceiling = 0.9;     // of a room's height: above doors and windows

/// A horizontal triangle.
struct Piece {
  std::uint32_t triangle;
  double height;  ///< of its middle
  double area;
  double covered = 0, open = 0;  ///< area with room above it, under something or not
};

std::vector<Piece> horizontal_pieces(const Scene& scene, const trace::PlanAxes& axes) {
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    if (std::abs(glm::dot(face_normal(scene, oriented(t, 0)), axes.up)) < steepest_cosine) continue;
    const auto [a, b, c] = scene.corners(t);
    const glm::dvec3 middle = (glm::dvec3(a) + glm::dvec3(b) + glm::dvec3(c)) / 3.0;
    pieces.push_back({t, glm::dot(middle, axes.up), triangle_area(scene, t)});
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.height < b.height; });
  return pieces;
}

/// Looks down from everywhere below the room's ceiling, to what there is most room above.
void measure_floor_of(const trace::Room& room, const RayScene& rays, const trace::PlanAxes& axes,
                      std::vector<Piece>& pieces) {
  std::unordered_map<std::uint32_t, Piece*> piece_of;
  for (Piece& piece : pieces) piece_of.emplace(piece.triangle, &piece);
  const trace::FlushDenormals flush_denormals;
  const glm::vec3 down(-axes.up);
  for (const glm::dvec3& place : room.positions()) {
    double above = glm::dot(place, axes.up);
    const double lowest = above - trace::Room::most_height;
    trace::RayOrigin from{glm::vec3(place)};
    for (int i = 0; i < most_surfaces_below; ++i) {
      const auto hit = trace::intersect(rays, from, down);
      if (!hit) break;
      const auto surface = trace::surface_hit(rays.scene(), *hit, down);
      const double height = glm::dot(glm::dvec3(surface.position), axes.up);
      if (height < lowest) break;
      const auto piece = piece_of.find(hit->triangle);
      if (piece != piece_of.end() && above - height >= least_room) {
        piece->second->covered += room.cell_area();
        break;
      }
      above = height;
      from = surface.origin_towards(down);
    }
  }
}

/// Looks up from points spread evenly over all pieces: `visit` is given the piece, its area that a
/// point stands for, the point, and the metres above it, HUGE_VAL in the open.
template <class Visit>
void measure_room(const RayScene& rays, const trace::PlanAxes& axes, std::vector<Piece>& pieces,
                  const Visit& visit) {
  const Scene& scene = rays.scene();
  const trace::FlushDenormals flush_denormals;
  const glm::vec3 up(axes.up);
  double total = 0, passed = 0;
  for (const Piece& piece : pieces) total += piece.area;
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < samples && next < pieces.size(); ++i) {
    const double target = (i + 0.5) / samples * total;
    while (next + 1 < pieces.size() && passed + pieces[next].area < target) {
      passed += pieces[next++].area;
    }
    Piece& piece = pieces[next];
    const trace::RandomBlock random =
        trace::RandomStream(0, i, 0).block(trace::Purpose::sensor_direction, 0);
    const glm::vec2 weights = trace::sample_triangle(random.uniform(0), random.uniform(1));
    const trace::TriangleHit where{piece.triangle, weights.x, weights.y};
    const auto point = trace::surface_hit(scene, where, -up);
    const auto above = trace::intersect(rays, point.origin_towards(up), up);
    double room = HUGE_VAL;
    if (above) {
      const auto ceiling = trace::surface_hit(scene, *above, up);
      room = glm::dot(glm::dvec3(ceiling.position - point.position), axes.up);
    }
    if (room >= least_room) visit(piece, total / samples, glm::dvec3(point.position), room);
  }
}

/// Pieces [first, end) of one height.
struct Level {
  std::size_t first, end;
  double room;
};

template <class RoomOf>
std::vector<Level> levels_of(const std::vector<Piece>& pieces, const RoomOf& room_of) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (levels.empty() || pieces[i].height - pieces[levels.back().first].height > level_thickness) {
      levels.push_back({i, i, 0});
    }
    levels.back().end = i + 1;
    levels.back().room += room_of(pieces[i]);
  }
  return levels;
}

using Cell = std::pair<int, int>;

/// Counterclockwise as seen from above.
constexpr std::array<Cell, 4> cell_sides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

Cell beyond(const Cell& cell, const Cell& side) {
  return {cell.first + side.first, cell.second + side.second};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The corners of walls of which a closed line has a point in each cell: straight parts of it, but
/// for the short one that cuts off the corner where two of them meet.
std::vector<glm::dvec2> corners_of(std::vector<glm::dvec2> line, double cell) {
  constexpr double straight = 0.002, longest_cut = 1.5;  // cells
  // What is farthest from anywhere is a corner, where a part may begin.
  const auto away = [from = line.front()](auto& point) { return glm::distance(point, from); };
  std::rotate(line.begin(), std::ranges::max_element(line, {}, away), line.end());
  line.push_back(line.front());
  std::vector<glm::dvec2> ends{line.front()};
  for (std::size_t first = 0, i = 1; i + 1 < line.size(); ++i) {
    const glm::dvec2 way = glm::normalize(line[i + 1] - line[first]);
    for (std::size_t k = first + 1; k <= i; ++k) {
      if (std::abs(cross(way, line[k] - line[first])) < straight * cell) continue;
      ends.push_back(line[first = i]);
      break;
    }
  }
  const auto end = [&](std::size_t i) { return ends[i % ends.size()]; };
  // Where the parts before and after a short one meet.
  const auto met_at = [&](std::size_t i) -> std::optional<glm::dvec2> {
    const glm::dvec2 before = end(i) - end(i + ends.size() - 1), after = end(i + 2) - end(i + 1);
    const double turn = cross(before, after);
    const glm::dvec2 met = end(i) + cross(end(i + 1) - end(i), after) / turn * before;
    const bool is_near = glm::distance(met, end(i)) < 2 * cell;
    const bool is_cut = glm::distance(end(i), end(i + 1)) < longest_cut * cell &&
                        std::min(glm::length(before), glm::length(after)) > longest_cut * cell;
    return is_cut && is_near ? std::optional(met) : std::nullopt;
  };
  std::vector<glm::dvec2> corners;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto met = met_at(i);
    if (met || !met_at(i + ends.size() - 1)) corners.push_back(met.value_or(end(i)));
  }
  return corners;
}

}  // namespace

Floor find_floor(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room* room) {
  std::vector<Piece> pieces = horizontal_pieces(rays.scene(), axes);
  if (room) {
    measure_floor_of(*room, rays, axes, pieces);
  } else {
    measure_room(rays, axes, pieces, [](Piece& piece, double area, const auto&, double above) {
      (above <= trace::Room::most_height ? piece.covered : piece.open) += area;
    });
  }
  const bool any_covered = std::any_of(pieces.begin(), pieces.end(),
                                       [](const Piece& piece) { return piece.covered > 0; });
  const std::vector<Level> levels = levels_of(
      pieces, [&](const Piece& piece) { return any_covered ? piece.covered : piece.open; });
  double widest = 0;
  for (const Level& level : levels) widest = std::max(widest, level.room);
  Floor floor;
  for (const Level& level : levels) {
    if (!(level.room > 0) || level.room < least_share * widest) continue;
    const auto begin = pieces.begin() + static_cast<std::ptrdiff_t>(level.first);
    const auto end = pieces.begin() + static_cast<std::ptrdiff_t>(level.end);
    double area = 0, lower = 0;
    std::for_each(begin, end, [&](const Piece& piece) { area += piece.area; });
    for (auto piece = begin; piece != end; ++piece) {  // ascending: a rug is higher than most
      floor.triangles.push_back(piece->triangle);
      if (lower < 0.5 * area) floor.height = piece->height;
      lower += piece->area;
    }
    break;
  }
  return floor;
}

double ceiling_height(const RayScene& rays, const trace::PlanAxes& axes, const trace::Room& room) {
  const trace::FlushDenormals flush_denormals;
  std::vector<double> heights;
  for (const glm::dvec3& place : room.positions()) {
    if (const auto hit = trace::intersect(rays, glm::vec3(place), glm::vec3(axes.up)))
      heights.push_back(glm::dot(trace::position_of(rays.scene(), *hit), axes.up));
  }
  if (heights.empty()) return room.cut_height();
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

RoomAtHeight::RoomAtHeight(const RayScene& rays, const trace::PlanAxes& axes,
                           const trace::Room& room, double height)
    : rays_(&rays),
      axes_(axes),
      side_(std::sqrt(room.cell_area())),
      low_(room.low()),
      high_(room.high()) {
  const trace::FlushDenormals flush_denormals;
  const double least = height + above_plane, most = std::max(least, room.cut_height());
  std::vector<Cell> next;
  // Where nothing is above a cell, it is outside.
  const auto add = [&](const Cell& cell, double cut) {
    const glm::vec3 up(axes.up);
    const auto hit = trace::intersect(rays, glm::vec3(middle_of(cell, cut)), up);
    if (!hit) return;
    const auto ceiling = trace::surface_hit(rays.scene(), *hit, up);
    const double above = glm::dot(glm::dvec3(ceiling.position), axes.up);
    if (above > cut + trace::Room::most_height) return;
    const bool is_level = std::abs(glm::dot(glm::dvec3(ceiling.normal), axes.up)) > steepest_cosine;
    cells_.emplace(cell, is_level ? cut : std::clamp(above - below_slope * side_, least, most));
    next.push_back(cell);
  };
  const std::vector<glm::dvec3> positions = room.positions();
  first_ = axes.plan(positions.front());
  for (const glm::dvec3& position : positions) {
    const glm::ivec2 cell(glm::round((axes.plan(position) - first_) / side_));
    add({cell.x, cell.y}, room.cut_height());
  }
  while (!next.empty()) {
    const Cell cell = next.back();
    next.pop_back();
    const double cut = cells_.at(cell);
    const glm::dvec3 from = middle_of(cell, cut);
    for (const Cell& side : cell_sides) {
      const Cell to = beyond(cell, side);
      const auto wall =
          trace::intersect(rays, glm::vec3(from), glm::vec3((middle_of(to, cut) - from) / side_));
      const glm::dvec3 end = wall ? trace::position_of(rays.scene(), *wall) : from;
      if (wall && glm::distance(end, from) <= side_) {
        low_ = glm::min(low_, axes.plan(end));
        high_ = glm::max(high_, axes.plan(end));
      } else if (!cells_.contains(to)) {
        add(to, cut);
      }
    }
  }
}

glm::dvec3 RoomAtHeight::middle_of(const Cell& cell, double height) const {
  const glm::dvec2 plan = first_ + side_ * glm::dvec2(cell.first, cell.second);
  return plan.x * axes_.right + plan.y * axes_.ahead + height * axes_.up;
}

bool RoomAtHeight::holds(const glm::dvec2& plan) const {
  constexpr double border_slack = 0.01;  // of a cell: a wall belongs to the room before it
  const glm::ivec2 nearest(glm::round((plan - first_) / side_));
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const auto cell = cells_.find({nearest.x + x, nearest.y + y});
      if (cell == cells_.end()) continue;
      const glm::dvec3 from = middle_of(cell->first, cell->second);
      const glm::dvec2 way = plan - axes_.plan(from);
      const double part =
          std::max(0.0, 1 - border_slack * side_ / std::max(glm::length(way), 1e-9));
      const glm::dvec3 to = from + part * (way.x * axes_.right + way.y * axes_.ahead);
      if (!trace::occluded(*rays_, glm::vec3(from), glm::vec3(to))) return true;
    }
  }
  return false;
}

glm::dvec2 RoomAtHeight::border_of(const Cell& cell, const Cell& side) const {
  const glm::dvec3 from = middle_of(cell, cells_.at(cell));
  const glm::dvec3 way = (middle_of(beyond(cell, side), cells_.at(cell)) - from) / side_;
  const auto wall = trace::intersect(*rays_, glm::vec3(from), glm::vec3(way));
  const glm::dvec3 end = wall ? trace::position_of(rays_->scene(), *wall) : from;
  // Where no wall is near, the ceiling ends between the two cells.
  return axes_.plan(wall && glm::distance(end, from) <= side_ ? end : from + 0.5 * side_ * way);
}

std::vector<std::vector<glm::dvec2>> RoomAtHeight::outlines() const {
  const trace::FlushDenormals flush_denormals;
  std::set<std::pair<Cell, std::size_t>> left;  // cells and those of their sides that are border
  for (const auto& [cell, cut] : cells_) {
    for (std::size_t side = 0; side < cell_sides.size(); ++side) {
      if (!cells_.contains(beyond(cell, cell_sides[side]))) left.emplace(cell, side);
    }
  }
  std::vector<std::vector<glm::dvec2>> rings;
  while (!left.empty()) {
    std::vector<glm::dvec2> border;
    auto [cell, side] = *left.begin();
    while (left.erase({cell, side}) != 0) {  // along the border, which is to the right
      border.push_back(border_of(cell, cell_sides[side]));
      const std::size_t along = (side + 1) % cell_sides.size();
      const Cell next = beyond(cell, cell_sides[along]);
      const Cell beside = beyond(next, cell_sides[side]);
      if (!cells_.contains(next)) {
        side = along;
      } else if (cells_.contains(beside)) {
        cell = beside;
        side = (side + cell_sides.size() - 1) % cell_sides.size();
      } else {
        cell = next;
      }
    }
    rings.push_back(corners_of(border, side_));
  }
  return rings;
}

std::vector<glm::dvec3> places_in_rooms(const RayScene& rays, const trace::PlanAxes& axes) {
  constexpr int directions = 8;
  std::vector<Piece> pieces = horizontal_pieces(rays.scene(), axes);
  std::vector<glm::dvec3> places;
  measure_room(rays, axes, pieces, [&](Piece&, double, const glm::dvec3& point, double room) {
    if (room > trace::Room::most_height) return;
    const glm::dvec3 from = point + near_ceiling * room * axes.up;
    for (int i = 0; i < directions; ++i) {
      const double angle = glm::two_pi<double>() * i / directions;
      const glm::vec3 way(std::cos(angle) * axes.right + std::sin(angle) * axes.ahead);
      const auto wall = trace::intersect(rays, glm::vec3(from), way);
      if (!wall) return;
      const auto surface = trace::surface_hit(rays.scene(), *wall, way);
      if (glm::distance(glm::dvec3(surface.position), from) < least_width / 2) return;
    }
    places.push_back(point + 0.5 * room * axes.up);
  });
  return places;
}

FloorPlan::FloorPlan(const Scene& scene, const Floor& floor, const trace::PlanAxes& axes,
                     const RoomAtHeight* room)
    : room_(room) {
  std::vector<std::array<glm::dvec2, 3>> plans;
  low_ = glm::dvec2(HUGE_VAL);
  high_ = -low_;
  for (const std::uint32_t triangle : floor.triangles) {
    const auto corners = scene.corners(triangle);
    auto& plan = plans.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      plan[i] = axes.plan(glm::dvec3(corners[i]));
      low_ = glm::min(low_, plan[i]);
      high_ = glm::max(high_, plan[i]);
    }
  }
  if (room_) {
    low_ = glm::max(low_, room_->low());
    high_ = glm::min(high_, room_->high());
  }
  const glm::dvec2 size = high_ - low_;
  pixel_ = std::max(size.x, size.y) / plan_pixels;
  width_ = std::max(1, static_cast<int>(std::ceil(size.x / pixel_)));
  height_ = std::max(1, static_cast<int>(std::ceil(size.y / pixel_)));
  covered_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (const auto& plan : plans) fill(plan);
}

void FloorPlan::fill(const std::array<glm::dvec2, 3>& corners) {
  const auto pixel_at = [&](double metres, int count) {
    return std::clamp(static_cast<int>(std::floor(metres / pixel_)), 0, count - 1);
  };
  const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]) - low_;
  const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]) - low_;
  const auto side_of = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  };
  // An edge that two triangles share leaves no gap: half a pixel counts as within.
  for (int y = pixel_at(low.y, height_); y <= pixel_at(high.y, height_); ++y) {
    for (int x = pixel_at(low.x, width_); x <= pixel_at(high.x, width_); ++x) {
      const glm::dvec2 middle = low_ + pixel_ * glm::dvec2(x + 0.5, y + 0.5);
      bool all_left = true, all_right = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2& a = corners[i];
        const glm::dvec2& b = corners[(i + 1) % 3];
        const double slack = 0.5 * pixel_ * glm::length(b - a);
        const double side = side_of(a, b, middle);
        all_left = all_left && side >= -slack;
        all_right = all_right && side <= slack;
      }
      if (all_left || all_right) {
        covered_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)] = true;
      }
    }
  }
}

bool FloorPlan::holds(const glm::dvec2& point) const {
  const glm::dvec2 at = (point - low_) / pixel_;
  // The border itself belongs to the floor.
  const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
  if (x < -1 || y < -1 || x > width_ || y > height_) return false;
  return covered_[static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) *
                      static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(std::clamp(x, 0, width_ - 1))] &&
         (!room_ || room_->holds(point));
}

bool FloorPlan::holds_disc(const glm::dvec2& middle, double radius) const {
  constexpr int directions = 32;
  bool inside = holds(middle);
  for (int i = 0; i < directions && inside; ++i) {
    const double angle = glm::two_pi<double>() * i / directions;
    inside = holds(middle + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return inside;
}

}  // namespace photile::measuring
