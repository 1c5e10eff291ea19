#include "measuring/plane_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>

#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::measuring {
namespace {

using nlohmann::json;

/// Cosine between sides that count as at a right angle.
constexpr double right_angle_slack = 1e-6;

PointCounts counts_of(const JsonObject& plane, double u, double v) {
  if (plane.has("columns") || plane.has("rows")) {
    if (plane.has("spacing")) plane.refuse("'spacing' and 'columns'; remove one of them");
    return {plane.count("columns", 1, limits::max_sensors),
            plane.count("rows", 1, limits::max_sensors)};
  }
  if (!plane.has("spacing")) return points_of_en12464(u, v);
  const double spacing = plane.metres("spacing");
  const double columns = std::max(1.0, std::round(u / spacing));
  const double rows = std::max(1.0, std::round(v / spacing));
  if (columns * rows > static_cast<double>(limits::max_sensors)) {
    plane.refuse(fmt::format("'spacing' makes more than {} points", limits::max_sensors));
  }
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

SensorGrid grid_of(const JsonObject& plane, const std::string& name) {
  PlaneLayout layout;
  layout.origin = plane.vector("origin");
  layout.u = plane.vector("u");
  layout.v = plane.vector("v");
  const double u = glm::length(layout.u), v = glm::length(layout.v);
  if (!(u > 0) || !(v > 0)) plane.refuse("'u' or 'v' has no length");
  if (std::abs(glm::dot(layout.u, layout.v)) > right_angle_slack * u * v) {
    plane.refuse("'u' and 'v' are not at a right angle");
  }
  const PointCounts counts = counts_of(plane, u, v);
  layout.columns = counts.columns;
  layout.rows = counts.rows;
  const std::uint64_t cells =
      static_cast<std::uint64_t>(layout.columns) * static_cast<std::uint64_t>(layout.rows);
  if (cells > limits::max_sensors) {
    plane.refuse(fmt::format("{} points are more than {}", cells, limits::max_sensors));
  }
  layout.cells.resize(cells);
  std::iota(layout.cells.begin(), layout.cells.end(), 0u);
  return grid_on_plane(plane.text("name", name), std::move(layout));
}

}  // namespace

std::vector<SensorGrid> read_planes(const std::filesystem::path& file) {
  const json content = read_input_json(file);
  const json list = content.is_array() ? content : json::array({content});
  if (list.empty()) throw InputError(fmt::format("{}: holds no plane", file.string()));
  std::vector<SensorGrid> grids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string number = list.size() > 1 ? std::to_string(i + 1) : "";
    const JsonObject plane(list[i], fmt::format("{}: plane {}", file.string(), i + 1),
                           {"name", "origin", "u", "v", "spacing", "columns", "rows"});
    grids.push_back(grid_of(plane, file.stem().string() + number));
  }
  return grids;
}

}  // namespace photile::measuring
