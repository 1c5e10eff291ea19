#include "measuring/furniture.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"
#include "trace/surface.hpp"

namespace photile::measuring {

namespace {

/// Surfaces this near to one another count as one crossing: sheets that lie on each other.
constexpr double beyond_hit = 1e-4;  // metres
constexpr int most_crossings = 1000;
constexpr double off_surface = 1e-3;  // metres
constexpr double touching = 0.01;     // metres to a surface beside or before a point
/// Metres: a narrower gap, such as one behind a counter, belongs to the furniture around it.
constexpr double slit = 0.1;

/// Number of surfaces on a ray.
int crossings(const RayScene& rays, glm::dvec3 from, const glm::dvec3& direction) {
  int count = 0;
  for (; count < most_crossings; ++count) {
    const auto hit = trace::intersect(rays, glm::vec3(from), glm::vec3(direction));
    if (!hit) break;
    from = trace::position_of(rays.scene(), *hit) + beyond_hit * direction;
  }
  return count;
}

/// A sensor's direction and two across it, at right angles.
std::array<glm::dvec3, 3> axes_of(const Sensor& sensor) {
  const glm::dvec3& n = sensor.normal;
  const glm::dvec3 hint = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 across = glm::normalize(glm::cross(n, hint));
  return {n, across, glm::cross(n, across)};
}

bool occluded(const RayScene& rays, const glm::dvec3& from, const glm::dvec3& to) {
  return trace::occluded(rays, glm::vec3(from), glm::vec3(to));
}

/// Tells of each of six rays, along and across the sensor's direction, whether it crosses an odd
/// number of surfaces.
using Parities = std::bitset<6>;
constexpr std::size_t rays_turned_inside = 5;

Parities parities_at(const RayScene& rays, const Sensor& sensor) {
  const std::array axes = axes_of(sensor);
  Parities odd;
  for (std::size_t ray = 0; ray < odd.size(); ++ray) {
    const double sign = ray % 2 == 0 ? 1 : -1;
    odd[ray] = crossings(rays, sensor.position, sign * axes[ray / 2]) % 2 == 1;
  }
  return odd;
}

Parities usual_parities(const std::vector<Parities>& all) {
  Parities usual;
  for (std::size_t ray = 0; ray < usual.size(); ++ray) {
    const auto odd = std::count_if(all.begin(), all.end(),
                                   [&](const Parities& parities) { return parities[ray]; });
    usual[ray] = 2 * static_cast<std::size_t>(odd) > all.size();
  }
  return usual;
}

bool has_surface_near(const RayScene& rays, const Sensor& sensor, double clearance, bool on_wall) {
  if (!(clearance > 0)) return false;
  const glm::dvec3 reach = clearance * sensor.normal;
  return occluded(rays, sensor.position - (on_wall ? 0.0 : 1.0) * reach, sensor.position + reach);
}

/// Whether a surface touches the sensor from the side, or lies just before it.
bool is_touched(const RayScene& rays, const Sensor& sensor) {
  const auto& [n, across, along] = axes_of(sensor);
  const glm::dvec3 place = sensor.position + off_surface * n;
  if (occluded(rays, sensor.position + beyond_hit * n, sensor.position + touching * n)) return true;
  for (const glm::dvec3& side :
       {across, along, glm::normalize(across + along), glm::normalize(across - along)}) {
    if (occluded(rays, place - touching * side, place + touching * side)) return true;
  }
  return false;
}

/// The air of rooms, and that under the open sky.
class OpenAir {
 public:
  OpenAir(const RayScene& rays, const SensorGrid& grid) : rays_(rays) {
    if (grid.chosen) {
      if (auto room = trace::Room::meant(rays, axes_, grid.inside))
        rooms_.push_back(*std::move(room));
    }
    if (rooms_.empty()) add_rooms_around(grid);
  }

  /// Whether nothing is between a point and the air below the ceiling, or the sky.
  bool holds(const glm::dvec3& point) const {
    for (const trace::Room& room : rooms_) {
      const glm::dvec3 below_ceiling =
          point + (room.cut_height() - glm::dot(point, axes_.up)) * axes_.up;
      if (!occluded(rays_, point, below_ceiling) && room.holds(axes_.plan(point))) return true;
    }
    return !trace::intersect(rays_, glm::vec3(point), glm::vec3(axes_.up));
  }

  /// Whether enough of the directions before a sensor end in that air.
  bool is_before(const Sensor& sensor) const {
    const auto [n, across, along] = axes_of(sensor);
    const glm::dvec3 from = sensor.position + off_surface * n;
    int open = 0;
    for (int i = 0; i < directions; ++i) {
      // A spiral over the hemisphere: even in solid angle.
      const double height = (i + 0.5) / directions;
      const double angle = glm::two_pi<double>() * std::fmod(i * glm::golden_ratio<double>(), 1.0);
      const double radius = std::sqrt(1 - height * height);
      const glm::dvec3 direction =
          height * n + radius * (std::cos(angle) * across + std::sin(angle) * along);
      const auto hit = trace::intersect(rays_, glm::vec3(from), glm::vec3(direction));
      if (hit) {
        const auto end = trace::surface_hit(rays_.scene(), *hit, glm::vec3(direction));
        const glm::dvec3 normal(end.normal), foot = glm::dvec3(end.position) + off_surface * normal;
        const glm::dvec3 before = foot + slit * normal;
        if (occluded(rays_, foot, before) || !holds(before)) continue;
      } else if (!(glm::dot(direction, axes_.up) > 0)) {
        continue;
      }
      if (++open >= open_directions) return true;
    }
    return false;
  }

 private:
  static constexpr int directions = 128, open_directions = directions / 8;
  static constexpr std::size_t most_tried = 64;
  /// The least size of a room for people, since cupboards have ceilings, too: metres of a side, and
  /// of the height below the cut.
  static constexpr double least_side = 0.8, below_cut = 1.6;

  /// The rooms around the grid's sensors, which are taken from all over it.
  void add_rooms_around(const SensorGrid& grid) {
    const Scene& scene = rays_.scene();
    const std::size_t step = std::max<std::size_t>(1, grid.sensors.size() / 16);
    std::size_t tried = 0;
    for (std::size_t start = 0; start < step; ++start) {
      for (std::size_t i = start; i < grid.sensors.size() && tried < most_tried; i += step) {
        const Sensor sensor = in_scene(scene, grid.sensors[i]);
        const glm::dvec3 point = sensor.position + off_surface * sensor.normal;
        if (holds(point)) continue;
        ++tried;
        auto room = trace::Room::around(rays_, axes_, point);
        if (room && is_for_people(*room)) rooms_.push_back(*std::move(room));
      }
    }
  }

  bool is_for_people(const trace::Room& room) const {
    const glm::dvec2 sides = room.high() - room.low();
    if (std::min(sides.x, sides.y) < least_side) return false;
    const std::vector<glm::dvec3> places = room.positions();
    return std::any_of(places.begin(), places.end(), [&](const glm::dvec3& place) {
      return !occluded(rays_, place, place - below_cut * axes_.up);
    });
  }

  const RayScene& rays_;
  const trace::PlanAxes axes_;
  std::vector<trace::Room> rooms_;
};

/// Whether two sensors see each other through a gap that is wide: a slit between two boards is
/// none.
bool are_in_one_air(const RayScene& rays, const Sensor& a, const Sensor& b) {
  constexpr double half_gap = slit / 2;
  const glm::dvec3 way = b.position - a.position;
  if (!(glm::length(way) > 0)) return true;
  const glm::dvec3 aside = half_gap * glm::normalize(glm::cross(a.normal, way));
  const glm::dvec3 up = half_gap * a.normal, off = off_surface * a.normal;
  for (const glm::dvec3& shift : {off, aside + off, off - aside, up, off - up}) {
    if (occluded(rays, a.position + shift, b.position + shift)) return false;
    if (occluded(rays, a.position + off, a.position + shift)) return false;
  }
  return true;
}

/// Tells of each sensor, given in the scene's coordinates, whether it lies in a thing.
std::vector<std::uint8_t> in_things(const RayScene& rays, const OpenAir& air,
                                    const SensorGrid& grid, const std::vector<Sensor>& sensors) {
  constexpr std::uint8_t in_air = 2, beside_it = 1;
  std::vector<std::uint8_t> open(sensors.size());
  tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
    const trace::FlushDenormals flush_denormals;
    const Sensor& sensor = sensors[i];
    open[i] = air.holds(sensor.position + off_surface * sensor.normal) ? in_air
              : air.is_before(sensor)                                  ? beside_it
                                                                       : 0;
  });
  if (grid.layout) {  // deep under a gallery or a stair: the air goes on from point to point
    const measuring::PlaneLayout& layout = *grid.layout;
    std::unordered_map<std::uint32_t, std::size_t> sensor_of;
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      sensor_of.emplace(layout.cells[i], i);
      if (open[i] == in_air) next.push_back(i);
    }
    const auto columns = static_cast<std::uint32_t>(layout.columns);
    while (!next.empty()) {
      const std::size_t from = next.back();
      next.pop_back();
      const std::uint32_t cell = layout.cells[from], column = cell % columns;
      for (const std::int64_t step :
           {std::int64_t{-1}, std::int64_t{1}, -std::int64_t{columns}, std::int64_t{columns}}) {
        if ((step == -1 && column == 0) || (step == 1 && column + 1 == columns)) continue;
        const auto to = sensor_of.find(static_cast<std::uint32_t>(cell + step));
        if (to == sensor_of.end() || open[to->second] == in_air) continue;
        if (!are_in_one_air(rays, sensors[from], sensors[to->second])) continue;
        open[to->second] = in_air;
        next.push_back(to->second);
      }
    }
  }
  const auto hidden = static_cast<std::size_t>(std::count(open.begin(), open.end(), 0));
  for (std::uint8_t& each : open) each = 2 * hidden <= open.size() && each == 0;
  return open;
}

/// "inside a solid or beyond the walls (3), less than 1 cm from a surface (2)", without reasons
/// that are known.
std::string reasons_of(const SensorGrid& grid, const CountedReasons& known) {
  std::string text;
  for (const auto& [reason, count] : counted_blanks(grid)) {
    if (std::ranges::count(known, reason, &CountedReasons::value_type::first)) continue;
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", reason, count);
  }
  return text;
}

}  // namespace

std::size_t leave_out_furniture(const Scene& scene, double clearance, SensorGrid& grid) {
  const RayScene rays(scene);
  const trace::FlushDenormals flush_denormals;
  const bool on_wall = grid.role == GridRole::wall || grid.role == GridRole::ceiling;
  std::vector<Sensor> places;
  std::vector<Parities> parities;
  for (const Sensor& sensor : grid.sensors) {
    const Sensor there = in_scene(scene, sensor);
    places.push_back(there);
    // Rays along a surface that the sensor lies on would meet its edges by chance.
    parities.push_back(
        parities_at(rays, {there.position + off_surface * there.normal, there.normal}));
  }
  const Parities usual = usual_parities(parities);
  const std::vector<std::uint8_t> hidden = in_things(rays, OpenAir(rays, grid), grid, places);
  std::vector<Sensor> sensors;
  std::vector<std::uint32_t> cells;
  std::vector<std::string> marks;
  std::vector<BlankPoint> blanks;
  auto before = grid.blanks.begin();
  const auto keep_blanks_before = [&](std::size_t sensor) {
    for (; before != grid.blanks.end() && before->before == sensor; ++before) {
      blanks.push_back({before->sensor, before->reason, sensors.size()});
    }
  };
  for (std::size_t i = 0; i < grid.sensors.size(); ++i) {
    keep_blanks_before(i);
    std::string reason, mark;
    if ((parities[i] ^ usual).count() >= rays_turned_inside) {
      reason = "inside a solid or beyond the walls";
    } else if (is_touched(rays, places[i])) {
      mark = fmt::format("less than {:g} cm from a surface", 100 * touching);
    } else if (hidden[i] != 0) {
      mark = "inside an object or a closed room";
    } else if (has_surface_near(rays, places[i], clearance, on_wall)) {
      reason = fmt::format("less than {} m from a surface", clearance);
    }
    if (grid.chosen && reason.empty()) reason = std::exchange(mark, "");
    if (!reason.empty()) {
      blanks.push_back({grid.sensors[i], reason, sensors.size()});
      continue;
    }
    sensors.push_back(grid.sensors[i]);
    marks.push_back(mark);
    if (grid.layout) cells.push_back(grid.layout->cells[i]);
  }
  keep_blanks_before(grid.sensors.size());
  const std::size_t left_out = grid.sensors.size() - sensors.size();
  grid.blanks = std::move(blanks);
  grid.sensors = std::move(sensors);
  grid.marks = std::move(marks);
  if (grid.layout) grid.layout->cells = std::move(cells);
  return left_out;
}

void clear_of_furniture(const Scene& scene, double clearance, bool may_lack,
                        std::vector<SensorGrid>& grids, Progress& progress) {
  for (SensorGrid& grid : grids) {
    if (!grid.remark.empty()) progress.warn(fmt::format("{}: {}", grid.name, grid.remark));
    const std::size_t all = grid.sensors.size();
    if (all == 0) continue;
    const CountedReasons known = counted_blanks(grid);
    const std::size_t blank = leave_out_furniture(scene, clearance, grid);
    if (grid.sensors.empty()) {
      const std::string reason = fmt::format(
          "{}: all {} points lie in objects or less than {} m from surfaces; give another height "
          "or position, or less clearance",
          grid.name, all, std::max(clearance, touching));
      if (!may_lack) throw UsageError(reason);
      progress.warn(reason);
      continue;
    }
    for (const auto& [mark, count] : counted_marks(grid)) {
      progress.warn(fmt::format("{}: {} of {} points: {}; they count in all results", grid.name,
                                count, all, mark));
    }
    if (blank == 0) continue;
    progress.note(fmt::format("{}: {} of {} points are left out: they lie {}", grid.name, blank,
                              all, reasons_of(grid, known)));
  }
  std::erase_if(grids, [](const SensorGrid& grid) { return grid.sensors.empty(); });
}

}  // namespace photile::measuring
