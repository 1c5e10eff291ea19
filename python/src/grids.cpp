// Grids of points: over floors, on walls and ceilings, of files and of arrays.
#include "grids.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "arrays.hpp"
#include "common/foreign_text.hpp"
#include "measuring/measurement.hpp"
#include "measuring/rooms.hpp"
#include "measuring/working_plane.hpp"
#include "parts.hpp"
#include "photile/limits.hpp"
#include "photile/ray_scene.hpp"
#include "report/plan_surroundings.hpp"
#include "report/tables.hpp"
#include "trace/portal_search.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

using measuring::GridRole;
using measuring::SensorGrid;

const char* name_of(GridRole role) {
  constexpr std::array names{"task",    "surroundings", "background", "wall",
                             "ceiling", "cylindrical",  "other"};
  return names[static_cast<std::size_t>(role)];
}

py::list grids(const SharedScene& scene, const py::dict& options, const py::object& progress) {
  const auto files = [&](const char* name) {
    return field<std::vector<std::string>>(options, name);
  };
  const auto length = [&](const char* name, double most) {
    const auto metres = field<double>(options, name);
    if (!(metres >= 0 && metres <= most))
      throw UsageError(std::string(name) + ": give metres from 0 on");
    return metres;
  };
  measuring::Places places{.planes = files("grid"),
                           .points = files("points"),
                           .plane = field<std::string>(options, "plane"),
                           .cylindrical = field<std::string>(options, "cylindrical_at"),
                           .semi_cylindrical = field<std::string>(options, "semi_cylindrical_at"),
                           .walls = field<bool>(options, "walls"),
                           .ceiling = field<bool>(options, "ceiling"),
                           .layout = {.wall_band = length("wall_band", limits::max_coordinate),
                                      .spacing = length("spacing", limits::max_coordinate),
                                      .north = field<double>(options, "north")},
                           .clearance = length("clearance", limits::max_coordinate)};
  if (!options["inside"].is_none()) {
    const auto place = field<std::array<double, 3>>(options, "inside");
    places.layout.inside = glm::dvec3(place[0], place[1], place[2]);
  }
  const auto names = field<std::string>(options, "rooms");
  auto found = run(progress, [&](Progress& told) {
    if (!names.empty()) places.rooms = measuring::rooms_named(*scene, names);
    return measuring::grids_at(*scene, places, told);
  });
  py::list list;
  for (SensorGrid& grid : found) list.append(std::make_shared<SensorGrid>(std::move(grid)));
  return list;
}

py::object rooms(const SharedScene& scene) {
  auto list = nlohmann::json::array();
  {
    const Unlocked unlocked;
    for (auto& room : measuring::rooms_of(*scene)) list.push_back(std::move(room.facts));
  }
  return parsed(json_text(list, -1));
}

/// Points of arrays, in the file's world.
SharedGrid grid_of_points(const std::string& name, const Array<double>& points,
                          const Array<double>& normals) {
  const auto places = rows_of<glm::dvec3>(points, "points");
  const auto directions = rows_of<glm::dvec3>(normals, "normals");
  if (places.size() != directions.size()) {
    throw InputError("normals: there are " + std::to_string(directions.size()) + " for " +
                     std::to_string(places.size()) + " points");
  }
  auto grid = std::make_shared<SensorGrid>();
  grid->name = name;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double size = glm::length(directions[i]);
    if (!(size > 0) || !std::isfinite(size)) {
      throw InputError("normals: normal " + std::to_string(i) + " has length 0");
    }
    grid->sensors.push_back({places[i], directions[i] / size});
  }
  return grid;
}

/// Shape (sensors, 3).
py::object rows_of_sensors(const SensorGrid& grid, glm::dvec3 Sensor::*member) {
  std::vector<glm::dvec3> rows;
  for (const Sensor& sensor : grid.sensors) rows.push_back(sensor.*member);
  const auto count = static_cast<py::ssize_t>(rows.size());
  return taken<double>(std::move(rows), {count, 3});
}

/// The plane of a grid as results have it; None where it is none.
py::object plane_of(const SensorGrid& grid) {
  if (!grid.layout) return py::none();
  return parsed(json_text(report::plane_json(*grid.layout), -1));
}

/// What a plan of that plane shows around it.
///   north   degrees, or None where it is not shown
py::object plan_of(const SharedScene& scene, const SensorGrid& grid,
                   const std::optional<double>& north) {
  if (!grid.layout) return py::none();
  std::string json;
  {
    const Unlocked unlocked;
    json = json_text(report::plan_json(RayScene(*scene), *grid.layout, north), -1);
  }
  return parsed(json);
}

}  // namespace

std::vector<SensorGrid> grids_of(const py::list& grids) {
  std::vector<SensorGrid> all;
  for (const py::handle& grid : grids) all.push_back(grid.cast<const SensorGrid&>());
  return all;
}

SharedScene with_portals(const SharedScene& scene, const std::vector<SensorGrid>& grids,
                         const std::vector<std::string>& asked) {
  // portals_of_grids without its question whether a light of the scene comes from beyond: those of
  // a year's skies are none of them.
  constexpr double above = 0.01;  // metres: a point may lie on a surface
  std::vector<glm::dvec3> points;
  for (const SensorGrid& grid : grids) {
    for (const Sensor& each : grid.sensors) {
      const Sensor sensor = in_scene(*scene, each);
      points.push_back(sensor.position + above * sensor.normal);
    }
  }
  auto copy = std::make_shared<Scene>(*scene);
  copy->portals = trace::portals_asked_for(*scene, asked, points);
  return copy;
}

SharedScene without_sky(const SharedScene& scene) {
  auto copy = std::make_shared<Scene>(*scene);
  while (!copy->lights.empty() && copy->lights.back().is_distant()) copy->lights.pop_back();
  return copy;
}

py::object parsed(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

void define_grids(py::module_& module) {
  py::class_<SensorGrid, SharedGrid>(module, "Grid")
      .def_property_readonly("name", [](const SensorGrid& grid) { return grid.name; })
      .def_property_readonly("role", [](const SensorGrid& grid) { return name_of(grid.role); })
      .def_property_readonly("marks", [](const SensorGrid& grid) { return grid.marks; })
      .def_property_readonly(
          "points", [](const SensorGrid& grid) { return rows_of_sensors(grid, &Sensor::position); })
      .def_property_readonly(
          "normals", [](const SensorGrid& grid) { return rows_of_sensors(grid, &Sensor::normal); })
      .def_property_readonly(
          "left_out",
          [](const SensorGrid& grid) {
            py::list list;
            for (const measuring::BlankPoint& blank : grid.blanks) {
              const glm::dvec3& p = blank.sensor.position;
              list.append(py::make_tuple(py::make_tuple(p.x, p.y, p.z), blank.reason));
            }
            return list;
          })
      .def_property_readonly("plane", &plane_of);
  module.def("grids", &grids);
  module.def("rooms", &rooms);
  module.def("grid_of_points", &grid_of_points);
  module.def("plan", &plan_of);
}

}  // namespace photile::python
