#include "measuring/sensor_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

namespace {

int whole(double count) { return static_cast<int>(std::clamp(std::round(count), 1.0, 1e6)); }

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

namespace {

void count(const std::string& reason, CountedReasons& counted) {
  if (reason.empty()) return;
  const auto found = std::find_if(counted.begin(), counted.end(),
                                  [&](const auto& each) { return each.first == reason; });
  if (found == counted.end()) {
    counted.emplace_back(reason, 1);
  } else {
    ++found->second;
  }
}

}  // namespace

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

/// Cosine between sides that count as at a right angle.
constexpr double right_angle_slack = 1e-6;

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

SensorGrid grid_of(const JsonObject& plane, const std::string& name) {
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
  return grid_on_plane(plane.text("name", name),
                       full_plane(plane.vector("origin"), along_u, along_v, counts));
}

/// The band around an area whose width in metres a key gives. Its cells are as wide as the area's,
/// those of a background as EN 12464-1 has them for a rectangle of its size.
SensorGrid band_around(const JsonObject& plane, const char* key, const PlaneLayout& inner,
                       GridRole role) {
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
  std::erase_if(outer.cells, [&](std::uint32_t cell) {
    const glm::dvec3 from = outer.middle_of(cell) - inner.origin;
    const double x = glm::dot(from, u), y = glm::dot(from, v);
    return x > 0 && x < across && y > 0 && y < along;
  });
  if (outer.cells.size() > limits::max_sensors) too_many();
  SensorGrid grid = grid_on_plane(key, std::move(outer));
  grid.role = role;
  return grid;
}

}  // namespace

std::vector<SensorGrid> read_planes(const std::filesystem::path& file) {
  const json content = read_input_json(file);
  const json list = content.is_array() ? content : json::array({content});
  if (list.empty()) throw InputError(fmt::format("{}: the file lists no planes", file.string()));
  std::vector<SensorGrid> grids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string number = list.size() > 1 ? std::to_string(i + 1) : "";
    const JsonObject plane(
        list[i], fmt::format("{}: plane {}", file.string(), i + 1),
        {"name", "origin", "u", "v", "spacing", "columns", "rows", "surroundings", "background"});
    grids.push_back(grid_of(plane, file.stem().string() + number));
    const std::string task = grids.back().name;
    for (const auto& [key, role] : {std::pair("surroundings", GridRole::surroundings),
                                    std::pair("background", GridRole::background)}) {
      if (!plane.has(key)) continue;
      SensorGrid band = band_around(plane, key, *grids.back().layout, role);
      band.name = task + " " + key;
      grids.push_back(std::move(band));
    }
  }
  return grids;
}

namespace {

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view separators = " \t,";
  std::vector<std::string_view> words;
  std::size_t first = 0;
  while ((first = line.find_first_not_of(separators, first)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(separators, first), line.size());
    words.push_back(line.substr(first, end - first));
    first = end;
  }
  return words;
}

Sensor sensor_of(const std::vector<std::string_view>& words, const std::string& where) {
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

SensorGrid read_points(const std::filesystem::path& file) {
  const std::string text = read_input_text(file);
  SensorGrid grid{file.stem().string(), {}, {}};
  std::size_t number = 0;
  for (const std::string_view line : lines_of(text)) {
    const auto words = words_of(line);
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
