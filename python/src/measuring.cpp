// Illuminance at points.
#include <pybind11/stl.h>

#include <cmath>

#include "arrays.hpp"
#include "parts.hpp"
#include "photile/sensors.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

/// A list of (light, lux, standard errors), all lights together first.
py::list measure(const std::shared_ptr<Scene>& scene, const Array<double>& points,
                 const Array<double>& normals, int rays, int repeats, bool cylindrical,
                 const std::string& integrator, double maintenance, double lumen_per_watt,
                 const py::dict& settings, const std::string& device, const py::object& progress) {
  const auto places = rows_of<glm::dvec3>(points, "points");
  const auto directions = rows_of<glm::dvec3>(normals, "normals");
  if (places.size() != directions.size()) {
    throw InputError("normals: there are " + std::to_string(directions.size()) + " for " +
                     std::to_string(places.size()) + " points");
  }
  MeasuringParameters parameters;
  parameters.by_paths = integrator == "path";
  if (!parameters.by_paths && integrator != "photon-map") {
    throw UsageError("integrator: '" + integrator + "' is not one of photon-map, path");
  }
  parameters.gathering.rays = rays;
  parameters.gathering.response =
      cylindrical ? SensorResponse::cylindrical : SensorResponse::planar;
  parameters.repeats = repeats;
  parameters.maintenance = maintenance;
  set_all(parameters.photons, settings);
  std::vector<Sensor> sensors;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double length = glm::length(directions[i]);
    if (!(length > 0) || !std::isfinite(length)) {
      throw InputError("normals: number " + std::to_string(i) + " has no direction");
    }
    sensors.push_back({places[i], directions[i] / length});
  }
  const LightMix mix = LightMix::of(*scene, lumen_per_watt);
  const auto found = run(progress, [&](Progress& told) {
    if (parameters.by_paths) {
      return measure_illuminance(*scene, sensors, mix, {}, parameters, told);
    }
    const auto open = devices_of(device);
    const std::lock_guard lock(open->mutex);
    return measure_illuminance(*scene, sensors, mix, open->devices, parameters, told);
  });
  py::list list;
  for (const LightIlluminance& light : found) {
    std::vector<double> values, errors;
    for (const Measured& reading : light.sensors) {
      values.push_back(reading.value);
      errors.push_back(reading.standard_error);
    }
    const auto count = static_cast<py::ssize_t>(values.size());
    list.append(py::make_tuple(light.light, taken<double>(std::move(values), {count}),
                               taken<double>(std::move(errors), {count})));
  }
  return list;
}

}  // namespace

void define_measuring(py::module_& module) { module.def("measure", &measure); }

}  // namespace photile::python
