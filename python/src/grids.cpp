// Grids of points: over floors, on walls and ceilings, of files and of arrays.
#include "grids.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "arrays.hpp"
#include "common/foreign_text.hpp"
#include "measuring/furniture.hpp"
#include "measuring/measurement.hpp"
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

/// The options of the command that say where it measures.
struct Places {
  std::vector<std::string> planes, points;  ///< files
  std::string plane, cylindrical, semi_cylindrical;
  bool walls = false, ceiling = false;
  measuring::WorkingPlane layout;  ///< but its height
  double clearance = 0;
};

/// Planes of a file: the background of a task ends at the walls of its room.
std::vector<SensorGrid> planes_in_rooms(const std::string& file, const Scene& scene) {
  constexpr double off_table = 0.05;  // metres
  glm::dvec3 task(0.0);
  std::vector<SensorGrid> grids = measuring::read_planes(file);
  for (SensorGrid& grid : grids) {
    const measuring::PlaneLayout& layout = *grid.layout;
    if (grid.role == GridRole::task)
      task = layout.origin + 0.5 * (layout.u + layout.v) + off_table * layout.normal();
    if (grid.role == GridRole::background) measuring::keep_in_room(scene, task, grid);
  }
  std::erase_if(grids, [](const SensorGrid& grid) { return grid.sensors.empty(); });
  return grids;
}

/// In the order of the command.
std::vector<SensorGrid> grids_at(const Places& places, const Scene& scene, Progress& progress) {
  std::vector<SensorGrid> grids;
  const auto add = [&](std::vector<SensorGrid> more) {
    for (SensorGrid& grid : more) grids.push_back(std::move(grid));
  };
  const auto at = [&](const std::string& height) {
    measuring::WorkingPlane plane = places.layout;
    const measuring::WorkingPlane level = measuring::parse_working_plane(height);
    plane.above_floor = level.above_floor;
    plane.height = level.height;
    return plane;
  };
  for (const std::string& file : places.planes) add(planes_in_rooms(file, scene));
  for (const std::string& file : places.points) add({measuring::read_points(file)});
  if (!places.plane.empty()) add({measuring::working_plane_grid(scene, at(places.plane))});
  if (places.walls) add(measuring::wall_grids(scene, at("floor")));
  if (places.ceiling) add({measuring::ceiling_grid(scene, at("floor"))});
  if (!places.cylindrical.empty())
    add({measuring::cylindrical_grid(scene, at(places.cylindrical))});
  if (!places.semi_cylindrical.empty())
    add(measuring::semi_cylindrical_grids(scene, at(places.semi_cylindrical)));
  std::size_t left = 0;
  for (SensorGrid& grid : grids) {
    measuring::leave_out_furniture(scene, places.clearance, grid, places.layout.inside);
    if (grid.sensors.empty()) {
      throw UsageError(grid.name +
                       ": no point is left, all lie in objects or too near to them; give " +
                       "another height or position, or less clearance");
    }
    if (!grid.remark.empty()) progress.warn(grid.name + ": " + grid.remark);
    left += grid.sensors.size();
  }
  if (left > limits::max_sensors) {
    throw UsageError(std::to_string(left) + " points together, more than " +
                     std::to_string(limits::max_sensors) + "; ask for fewer");
  }
  return grids;
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
  std::optional<glm::dvec3> inside;
  if (!options["inside"].is_none()) {
    const auto place = field<std::array<double, 3>>(options, "inside");
    inside = glm::dvec3(place[0], place[1], place[2]);
  }
  const Places places{.planes = files("grid"),
                      .points = files("points"),
                      .plane = field<std::string>(options, "plane"),
                      .cylindrical = field<std::string>(options, "cylindrical_at"),
                      .semi_cylindrical = field<std::string>(options, "semi_cylindrical_at"),
                      .walls = field<bool>(options, "walls"),
                      .ceiling = field<bool>(options, "ceiling"),
                      .layout = {.wall_band = length("wall_band", limits::max_coordinate),
                                 .spacing = length("spacing", limits::max_coordinate),
                                 .north = field<double>(options, "north"),
                                 .inside = inside},
                      .clearance = length("clearance", limits::max_coordinate)};
  auto found = run(progress, [&](Progress& told) { return grids_at(places, *scene, told); });
  py::list list;
  for (SensorGrid& grid : found) list.append(std::make_shared<SensorGrid>(std::move(grid)));
  return list;
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
  module.def("grid_of_points", &grid_of_points);
  module.def("plan", &plan_of);
}

}  // namespace photile::python
