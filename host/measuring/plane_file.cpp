#include "measuring/plane_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <utility>

#include "input_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::measuring {
namespace {

using nlohmann::json;

/// Cosine between sides that count as at a right angle.
constexpr double right_angle_slack = 1e-6;

/// One plane of a file, for messages.
class Plane {
 public:
  Plane(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) refuse("is no object {...}");
    static const std::set<std::string> known{"name",    "origin",  "u",   "v",
                                             "spacing", "columns", "rows"};
    for (const auto& [key, value] : object.items()) {
      if (known.count(key) == 0) {
        refuse(fmt::format(
            "'{}' is not known; there are name, origin, u, v, spacing, columns, rows", key));
      }
    }
  }

  bool has(const char* key) const { return object_.contains(key); }

  glm::dvec3 vector(const char* key) const {
    const json value = object_.value(key, json());
    const auto is_coordinate = [](const json& number) {
      return number.is_number() && std::abs(number.get<double>()) <= limits::max_coordinate;
    };
    if (!value.is_array() || value.size() != 3 ||
        !std::all_of(value.begin(), value.end(), is_coordinate)) {
      refuse(fmt::format("'{}' is not three numbers of metres", key));
    }
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }

  double metres(const char* key) const {
    const json value = object_.value(key, json());
    if (!value.is_number() || !(value.get<double>() > 0) ||
        !(value.get<double>() <= limits::max_coordinate)) {
      refuse(fmt::format("'{}' is not a number of metres above 0", key));
    }
    return value.get<double>();
  }

  int count(const char* key) const {
    const json value = object_.value(key, json());
    if (!value.is_number_integer() || value.get<double>() < 1 ||
        value.get<double>() > static_cast<double>(limits::max_sensors)) {
      refuse(fmt::format("'{}' is not a whole number from 1 to {}", key, limits::max_sensors));
    }
    return value.get<int>();
  }

  std::string name(const std::string& otherwise) const {
    const json value = object_.value("name", json(otherwise));
    if (!value.is_string() || value.get<std::string>().empty()) refuse("'name' is no text");
    return value.get<std::string>();
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", where_, reason));
  }

 private:
  const json& object_;
  std::string where_;
};

PointCounts counts_of(const Plane& plane, double u, double v) {
  if (plane.has("columns") || plane.has("rows")) {
    if (plane.has("spacing")) plane.refuse("'spacing' and 'columns'; remove one of them");
    return {plane.count("columns"), plane.count("rows")};
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

SensorGrid grid_of(const Plane& plane, const std::string& name) {
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
  return grid_on_plane(plane.name(name), std::move(layout));
}

}  // namespace

std::vector<SensorGrid> read_planes(const std::filesystem::path& file) {
  const json content = json::parse(read_input_text(file), nullptr, /*allow_exceptions=*/false);
  if (content.is_discarded()) {
    throw InputError(fmt::format("{}: is no JSON", file.string()));
  }
  const json list = content.is_array() ? content : json::array({content});
  if (list.empty()) throw InputError(fmt::format("{}: holds no plane", file.string()));
  std::vector<SensorGrid> grids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string number = list.size() > 1 ? std::to_string(i + 1) : "";
    const Plane plane(list[i], fmt::format("{}: plane {}", file.string(), i + 1));
    grids.push_back(grid_of(plane, file.stem().string() + number));
  }
  return grids;
}

}  // namespace photile::measuring
