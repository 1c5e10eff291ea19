// Glare ratings of observers.
#include <pybind11/stl.h>

#include "common/foreign_text.hpp"
#include "glare/measure_glare.hpp"
#include "grids.hpp"
#include "parts.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/tables.hpp"
#include "trace/room.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

/// Observers at the points of a grid: looking round where it is a plane, else as its points face.
std::vector<glare::Observer> observers_of_grid(measuring::SensorGrid grid, int directions,
                                               const trace::PlanAxes& axes) {
  if (!grid.layout) return glare::observers_at(grid, axes);
  grid.name = "point";
  return glare::observers_on(grid, axes, directions);
}

/// Of grids and cameras.
std::vector<glare::Observer> observers_of(const SharedScene& scene, const py::list& places,
                                          int directions) {
  const auto axes = trace::PlanAxes::in_world(*scene);
  std::vector<glare::Observer> all;
  for (const py::handle& place : places) {
    if (py::isinstance<measuring::SensorGrid>(place)) {
      for (auto& one : observers_of_grid(place.cast<measuring::SensorGrid>(), directions, axes))
        all.push_back(std::move(one));
      continue;
    }
    const Camera eye =
        in_world(*scene, chosen_camera(*scene, py::reinterpret_borrow<py::object>(place)));
    all.push_back(glare::Observer::looking(eye.name, eye.position, eye.forward, eye.up));
  }
  if (all.empty()) throw UsageError("observers: there is none");
  if (2 * all.size() > limits::max_sensors) {
    throw UsageError(std::to_string(all.size()) + " observers, more than " +
                     std::to_string(limits::max_sensors / 2) + "; rate fewer");
  }
  return all;
}

/// The observers as `photile glare` writes them to .json.
py::object rate_glare(const SharedScene& scene, const py::list& places, const py::dict& options,
                      const py::dict& settings, const py::object& progress) {
  const auto directions = field<int>(options, "directions");
  if (directions < 1 || directions > 360)
    throw UsageError("directions: give a whole number from 1 to 360");
  const auto observers = observers_of(scene, places, directions);
  const auto device = field<std::string>(options, "device");
  glare::GlareParameters parameters;
  parameters.by_pictures = field<bool>(options, "by_pictures");
  parameters.picture_side = field<int>(options, "picture_size");
  parameters.search.threshold = field<double>(options, "source_luminance");
  parameters.measuring.by_paths = is_by_paths(options);
  parameters.measuring.gathering.rays = field<int>(options, "rays");
  parameters.measuring.repeats = field<int>(options, "repeats");
  set_all(parameters.measuring.photons, settings);
  check_measuring(parameters.measuring);
  if (parameters.picture_side < 16 || parameters.picture_side > limits::max_image_side) {
    throw UsageError("picture_size: give a whole number from 16 to " +
                     std::to_string(limits::max_image_side));
  }
  if (!(parameters.search.threshold > 0))
    throw UsageError("source_luminance: give a number above 0");
  const LightMix mix = mix_of(*scene, options);
  const std::string json = run(progress, [&](Progress& told) {
    const double coverage =
        glare::coverage_by_luminaires(*scene, observers.front(), parameters.samples);
    const auto all =
        with_devices(parameters.measuring.by_paths, device, [&](std::span<Device> devices) {
          return glare::measure_glare(*scene, observers, mix, coverage, devices, parameters, {},
                                      told);
        });
    return json_text(report::glare_json(all), -1);
  });
  return parsed(json);
}

}  // namespace

void define_glare(py::module_& module) { module.def("glare", &rate_glare); }

}  // namespace photile::python
