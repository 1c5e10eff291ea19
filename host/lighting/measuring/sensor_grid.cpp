#include "measuring/sensor_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <sstream>
#include <string_view>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/json_object.hpp"
#include "measuring/requirements.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

namespace {

int whole(double count) { return static_cast<int>(std::clamp(std::round(count), 1.0, 1e6)); }

void count(const std::string& reason, CountedReasons& counted) {
  if (reason.empty()) return;
  const auto found = std::ranges::find(counted, reason, &CountedReasons::value_type::first);
  if (found == counted.end()) {
    counted.emplace_back(reason, 1);
  } else {
    ++found->second;
  }
}

}  // namespace

glm::dvec3 PlaneLayout::at(const glm::dvec2& in_cells) const {
  return origin + in_cells.x / columns * u + in_cells.y / rows * v;
}

glm::dvec2 PlaneLayout::in_cells(const glm::dvec3& point) const {
  const glm::dvec3 from = point - origin;
  return {glm::dot(from, u) / glm::dot(u, u) * columns, glm::dot(from, v) / glm::dot(v, v) * rows};
}

glm::dvec3 PlaneLayout::middle_of(std::uint32_t cell) const {
  const auto in_row = static_cast<std::uint32_t>(columns);
  return at({cell % in_row + 0.5, cell / in_row + 0.5});
}

CountedReasons counted_blanks(const SensorGrid& grid) {
  CountedReasons counted;
  for (const BlankPoint& blank : grid.blanks) count(blank.reason, counted);
  return counted;
}

CountedReasons counted_marks(const SensorGrid& grid) {
  CountedReasons counted;
  for (const std::string& mark : grid.marks) count(mark, counted);
  return counted;
}

PlaneLayout in_world(const Scene& scene, PlaneLayout layout) {
  layout.origin = position_in_world(scene, layout.origin);
  layout.u = direction_in_world(scene, layout.u);
  layout.v = direction_in_world(scene, layout.v);
  return layout;
}

PlaneLayout in_scene(const Scene& scene, PlaneLayout layout) {
  layout.origin = position_in_scene(scene, layout.origin);
  layout.u = direction_in_scene(scene, layout.u);
  layout.v = direction_in_scene(scene, layout.v);
  return layout;
}

SensorGrid grid_on_plane(const std::string& name, PlaneLayout layout) {
  SensorGrid grid{name, {}, {}};
  const glm::dvec3 normal = layout.normal() + 0.0;  // no -0 in tables
  for (const std::uint32_t cell : layout.cells) {
    grid.sensors.push_back({layout.middle_of(cell), normal});
  }
  grid.layout = std::move(layout);
  return grid;
}

PointCounts points_of_en12464(double u, double v) {
  const double longer = std::max(u, v), shorter = std::min(u, v);
  const double d = longer >= 2 * shorter ? shorter : longer;
  const double spacing = std::min(10.0, 0.2 * std::pow(5.0, std::log10(d)));
  const double resulting = d / whole(d / spacing);
  return {whole(u / resulting), whole(v / resulting)};
}

PointCounts points_at(double u, double v, double spacing) {
  if (!(spacing > 0)) return points_of_en12464(u, v);
  return {whole(u / spacing), whole(v / spacing)};
}

PlaneLayout full_plane(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v,
                       const PointCounts& counts) {
  PlaneLayout layout{origin, u, v, counts.columns, counts.rows, {}};
  layout.cells.resize(counts.total());
  std::iota(layout.cells.begin(), layout.cells.end(), 0u);
  return layout;
}

namespace {

using nlohmann::json;

constexpr double right_angle_slack = 1e-6;  // cosine between sides
constexpr double rounding = 1e-3;           // metres that corners may lie beyond them

PointCounts counts_of(const JsonObject& plane, double u, double v) {
  if (plane.has("columns") || plane.has("rows")) {
    if (plane.has("spacing")) plane.refuse("has both 'spacing' and 'columns'; remove one");
    return {plane.count("columns", 1, limits::max_sensors),
            plane.count("rows", 1, limits::max_sensors)};
  }
  if (!plane.has("spacing")) return points_of_en12464(u, v);
  const PointCounts counts = points_at(u, v, plane.metres("spacing"));
  if (counts.total() > limits::max_sensors) {
    plane.refuse(fmt::format("'spacing' makes more than {} points", limits::max_sensors));
  }
  return counts;
}

/// Corners of what is measured of a plane, metres along its u and v, 0. None = the whole rectangle.
using Outline = std::vector<glm::dvec3>;

Outline outline_of(const JsonObject& plane, const json& corners) {
  std::vector<std::array<double, 2>> points;
  try {
    points = corners.get<decltype(points)>();
  } catch (const json::exception&) {  // no points are left, which the comparison finds
  }
  if (json(points) != corners || points.size() < 3 || points.size() > limits::max_outline_corners) {
    plane.refuse(
        fmt::format("'outline' is not a list of 3 to {} points [x, y], in metres along u and v",
                    limits::max_outline_corners));
  }
  Outline outline;
  for (const auto& [x, y] : points) outline.emplace_back(x, y, 0.0);
  return outline;
}

/// Metres from a point of a plane to an outline, negative within it (by the even-odd rule).
double distance(const Outline& outline, const PlaneLayout& plane, const glm::dvec3& point) {
  const glm::dvec2 cell(plane.spacing(), glm::length(plane.v) / plane.rows);  // metres
  const glm::dvec3 at(cell * plane.in_cells(point), 0.0);
  bool within = false;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec3 to = at - outline[i], side = outline[(i + 1) % outline.size()] - outline[i];
    if ((to.y < 0) != (to.y < side.y)) within ^= to.x < to.y / side.y * side.x;
    const double share = glm::dot(to, side) / std::max(glm::dot(side, side), 1e-300);
    least = std::min(least, glm::length(to - std::clamp(share, 0.0, 1.0) * side));
  }
  return within ? -least : least;
}

SensorGrid grid_of(const JsonObject& plane, const std::string& name, const Outline& outline) {
  const glm::dvec3 along_u = plane.vector("u"), along_v = plane.vector("v");
  const double u = glm::length(along_u), v = glm::length(along_v);
  if (!(u > 0) || !(v > 0)) plane.refuse("'u' or 'v' has length 0");
  if (std::abs(glm::dot(along_u, along_v)) > right_angle_slack * u * v) {
    plane.refuse("'u' and 'v' are not perpendicular");
  }
  const PointCounts counts = counts_of(plane, u, v);
  if (counts.total() > limits::max_sensors) {
    plane.refuse(fmt::format("{} points; the limit is {}", counts.total(), limits::max_sensors));
  }
  for (const glm::dvec3& corner : outline) {
    const double outside = std::max({-corner.x, -corner.y, corner.x - u, corner.y - v});
    if (outside > rounding) plane.refuse("'outline' leaves the rectangle of 'u' and 'v'");
  }
  PlaneLayout layout = full_plane(plane.vector("origin"), along_u, along_v, counts);
  std::erase_if(layout.cells, [&](std::uint32_t cell) {
    return !outline.empty() && distance(outline, layout, layout.middle_of(cell)) > 0;
  });
  if (layout.cells.empty())
    plane.refuse("no point lies in 'outline'; enlarge it or reduce 'spacing'");
  SensorGrid grid = grid_on_plane(plane.text("name", name), std::move(layout));
  if (!plane.has("target")) return grid;
  grid.target = plane.text("target", "");
  try {
    parse_requirement(grid.target);
  } catch (const UsageError& error) {
    plane.refuse(error.what());
  }
  return grid;
}

/// The band around an area whose width in metres a key gives. Its cells are as wide as the area's,
/// those of a background as EN 12464-1 has them for a rectangle of its size. Around an outline it
/// has round corners.
SensorGrid band_around(const JsonObject& plane, const char* key, const PlaneLayout& inner,
                       GridRole role, const Outline& outline, const PlaneLayout& task) {
  const double band = plane.metres(key);
  const double across = glm::length(inner.u), along = glm::length(inner.v);
  const glm::dvec3 u = inner.u / across, v = inner.v / along;
  const double outer_across = across + 2 * band, outer_along = along + 2 * band;
  double spacing = std::min(inner.spacing(), band);
  if (role == GridRole::background) {
    spacing = std::min(band, outer_across / points_of_en12464(outer_across, outer_along).columns);
  }
  const PointCounts counts = points_at(outer_across, outer_along, spacing);
  const auto too_many = [&] {
    plane.refuse(fmt::format("'{}' makes more than {} points", key, limits::max_sensors));
  };
  if (counts.total() > 2 * limits::max_sensors) too_many();  // the area is a part
  PlaneLayout outer =
      full_plane(inner.origin - band * (u + v), outer_across * u, outer_along * v, counts);
  const double already = 0.5 * (across - glm::length(task.u));
  std::erase_if(outer.cells, [&](std::uint32_t cell) {
    const glm::dvec3 middle = outer.middle_of(cell);
    if (!outline.empty()) {
      const double gap = distance(outline, task, middle);
      return gap < already || gap > already + band;
    }
    const glm::dvec2 at = inner.in_cells(middle);
    return at.x > 0 && at.x < inner.columns && at.y > 0 && at.y < inner.rows;
  });
  if (outer.cells.size() > limits::max_sensors) too_many();
  SensorGrid grid = grid_on_plane(key, std::move(outer));
  grid.role = role;
  return grid;
}

std::vector<std::string> words_of(std::string line) {
  std::ranges::replace(line, ',', ' ');
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

Sensor sensor_of(const std::vector<std::string>& words, const std::string& where) {
  if (words.size() != 6) {
    throw InputError(
        fmt::format("{}: {} numbers; a point has 6: x y z dx dy dz", where, words.size()));
  }
  std::array<double, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = parse_signed(words[i]);
    if (!number || std::abs(*number) > limits::max_coordinate) {
      throw InputError(
          fmt::format("{}: '{}' is not a number of metres; write x y z dx dy dz", where, words[i]));
    }
    numbers[i] = *number;
  }
  const glm::dvec3 facing(numbers[3], numbers[4], numbers[5]);
  const double length = glm::length(facing);
  if (!(length > 0)) {
    throw InputError(fmt::format("{}: the direction has length 0; give another", where));
  }
  return {{numbers[0], numbers[1], numbers[2]}, facing / length};
}

}  // namespace

std::vector<SensorGrid> read_planes(const std::filesystem::path& file) {
  const json content = read_input_json(file);
  const json list = content.is_array() ? content : json::array({content});
  if (list.empty()) throw InputError(fmt::format("{}: the file lists no planes", file.string()));
  std::vector<SensorGrid> grids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string number = list.size() > 1 ? std::to_string(i + 1) : "";
    const JsonObject plane(list[i], fmt::format("{}: plane {}", file.string(), i + 1),
                           {"name", "origin", "u", "v", "outline", "spacing", "columns", "rows",
                            "surroundings", "background", "target"});
    const Outline outline =
        plane.has("outline") ? outline_of(plane, list[i]["outline"]) : Outline();
    grids.push_back(grid_of(plane, file.stem().string() + number, outline));
    const SensorGrid task = grids.back();
    for (const auto& [key, role] : {std::pair("surroundings", GridRole::surroundings),
                                    std::pair("background", GridRole::background)}) {
      if (!plane.has(key)) continue;
      SensorGrid band = band_around(plane, key, *grids.back().layout, role, outline, *task.layout);
      band.name = task.name + " " + key;
      band.target = task.target;
      grids.push_back(std::move(band));
    }
  }
  return grids;
}

SensorGrid read_points(const std::filesystem::path& file) {
  const std::string text = read_input_text(file);
  SensorGrid grid{file.stem().string(), {}, {}};
  std::size_t number = 0;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(std::string(line));
    ++number;
    if (words.empty() || words.front().starts_with('#')) continue;
    grid.sensors.push_back(sensor_of(words, fmt::format("{}: line {}", file.string(), number)));
    if (grid.sensors.size() > limits::max_sensors) {
      throw InputError(fmt::format("{}: more than {} points; split the file", file.string(),
                                   limits::max_sensors));
    }
  }
  if (grid.sensors.empty()) {
    throw InputError(fmt::format("{}: no points; each is a line x y z dx dy dz", file.string()));
  }
  return grid;
}

}  // namespace photile::measuring
