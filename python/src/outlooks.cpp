// What EN 17037 asks of windows: where straight lines from points end, where windows are, and where
// the sun stands.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numbers>

#include "arrays.hpp"
#include "grids.hpp"
#include "loading/surroundings.hpp"
#include "parts.hpp"
#include "photile/ray_scene.hpp"
#include "scene/panes.hpp"
#include "trace/portal_search.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"
#include "weather/perez_sky.hpp"
#include "weather/weather_file.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

/// Where a straight line ends.
struct End {
  double distance = std::numeric_limits<double>::infinity();  ///< metres; infinite beyond the scene
  double upwards = 0;  ///< sine by which the surface there, seen from the line, faces upwards
};

/// The first surface on the line that is neither glazing nor mostly absent.
End end_of(const RayScene& rays, const glm::vec3& from, const glm::vec3& direction) {
  constexpr int most_surfaces = 256;
  const Scene& scene = rays.scene();
  trace::RayOrigin origin = from;
  for (int surfaces = 0; surfaces < most_surfaces; ++surfaces) {
    const auto hit = trace::intersect(rays, origin, direction);
    if (!hit) return {};
    const trace::SurfacePoint point = trace::surface_hit(scene, *hit, direction);
    const glm::dvec3 passing(trace::transmittance(scene, point, direction));
    if (!scene::is_glazing(trace::material_of(scene, point)) && !(luminance(passing) > 0.5))
      return {glm::distance(glm::dvec3(from), glm::dvec3(point.position)), point.normal.y};
    origin = point.origin_towards(direction);
  }
  return {};
}

/// A scene's surfaces, kept between questions.
struct Surroundings {
  SharedScene scene;
  RayScene rays;
};

std::shared_ptr<Surroundings> surroundings_of(const SharedScene& scene) {
  const Unlocked unlocked;
  return std::make_shared<Surroundings>(Surroundings{scene, RayScene(*scene)});
}

/// (metres, sine by which the surface faces upwards) of lines from points, all in the world.
py::tuple ends_of(const Surroundings& around, const Array<double>& points,
                  const Array<double>& directions) {
  const auto from = rows_of<glm::dvec3>(points, "points");
  const auto towards = rows_of<glm::dvec3>(directions, "directions");
  std::vector<double> distances(from.size()), upwards(from.size());
  {
    const Unlocked unlocked;
    constexpr std::size_t run = 1024;  // lines that a thread takes at once
    tbb::parallel_for(std::size_t{0}, (from.size() + run - 1) / run, [&](std::size_t part) {
      const trace::FlushDenormals flush_denormals;
      for (std::size_t i = part * run; i < std::min((part + 1) * run, from.size()); ++i) {
        const End end =
            end_of(around.rays, glm::vec3(position_in_scene(*around.scene, from[i])),
                   glm::vec3(direction_in_scene(*around.scene, glm::normalize(towards[i]))));
        distances[i] = end.distance;
        upwards[i] = end.upwards;
      }
    });
  }
  const auto count = static_cast<py::ssize_t>(distances.size());
  return py::make_tuple(taken<double>(std::move(distances), {count}),
                        taken<double>(std::move(upwards), {count}));
}

/// A pattern of this name alone.
std::string escaped(const std::string& name) {
  std::string pattern;
  for (const char c : name)
    pattern += std::string("*?[\\").find(c) == std::string::npos ? std::string(1, c)
                                                                 : std::string("\\") + c;
  return pattern;
}

/// Rows of corner and sides u and v, in the world, of the panes of materials; u x v points inwards.
///   asked   patterns of their names; empty = all glazing
py::object windows_of(const SharedScene& scene, std::vector<std::string> asked) {
  std::vector<glm::dvec3> rows;
  {
    const Unlocked unlocked;
    const bool all = asked.empty();
    for (std::size_t i = 0; i < scene->materials.size() && all; ++i) {
      const auto& used = scene->triangle_material;
      const Material& material = scene->materials[i];
      if (scene::is_glazing(material) && std::ranges::find(used, i) != used.end())
        asked.push_back(escaped(material.name));
    }
    for (const Portal& portal : trace::portals_of_materials(*scene, asked)) {
      rows.push_back(position_in_world(*scene, portal.corner));
      rows.push_back(direction_in_world(*scene, portal.u));
      rows.push_back(direction_in_world(*scene, portal.v));
    }
  }
  const auto count = static_cast<py::ssize_t>(rows.size() / 3);
  return taken<double>(std::move(rows), {count, 3, 3});
}

/// Unit vectors to the right, ahead and upwards of a plan, in the world.
py::object axes_of(const SharedScene& scene) {
  const auto axes = trace::PlanAxes::in_world(*scene);
  return taken<double>(std::vector<glm::dvec3>{axes.right, axes.ahead, axes.up}, {3, 3});
}

/// Unit vectors towards the sun in the world, and radians above the horizon.
///   weather   whose site counts where `site` is ""
///   north     degrees clockwise from -z
///   hours     from midnight, standard time
py::tuple suns_of(const SharedScene& scene, const std::string& site,
                  const std::filesystem::path& weather, double north, const std::string& day,
                  const std::vector<double>& hours) {
  const Site place = site.empty() ? weather::read_weather(weather).site : Site::parse(site);
  LocalTime time = LocalTime::parse(day + "T00:00");
  std::vector<glm::dvec3> directions;
  std::vector<double> elevations;
  for (const double hour : hours) {
    time.hour = hour;
    const weather::SunPosition position = weather::sun_position(place, time);
    Sun sun;
    sun.azimuth_degrees = position.azimuth * 180 / std::numbers::pi + north;
    sun.elevation_degrees = position.elevation * 180 / std::numbers::pi;
    directions.push_back(direction_in_world(*scene, loading::direction_to(sun)));
    elevations.push_back(position.elevation);
  }
  const auto count = static_cast<py::ssize_t>(hours.size());
  return py::make_tuple(taken<double>(std::move(directions), {count, 3}),
                        taken<double>(std::move(elevations), {count}));
}

}  // namespace

void define_outlooks(py::module_& module) {
  py::class_<Surroundings, std::shared_ptr<Surroundings>>(module, "Surroundings")
      .def("ends", &ends_of);
  module.def("surroundings", &surroundings_of);
  module.def("windows", &windows_of);
  module.def("axes", &axes_of);
  module.def("suns", &suns_of);
}

}  // namespace photile::python
