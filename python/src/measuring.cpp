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
                 const Array<double>& normals, const py::dict& options, const py::dict& settings,
                 const py::object& progress) {
  const auto places = rows_of<glm::dvec3>(points, "points");
  const auto directions = rows_of<glm::dvec3>(normals, "normals");
  if (places.size() != directions.size()) {
    throw InputError("normals: there are " + std::to_string(directions.size()) + " for " +
                     std::to_string(places.size()) + " points");
  }
  const auto integrator = field<std::string>(options, "integrator");
  const auto device = field<std::string>(options, "device");
  MeasuringParameters parameters;
  parameters.by_paths = integrator == "path";
  if (!parameters.by_paths && integrator != "photon-map") {
    throw UsageError("integrator: '" + integrator + "' is not one of photon-map, path");
  }
  parameters.gathering.rays = field<int>(options, "rays");
  parameters.gathering.response =
      field<bool>(options, "cylindrical") ? SensorResponse::cylindrical : SensorResponse::planar;
  parameters.repeats = field<int>(options, "repeats");
  parameters.maintenance = field<double>(options, "maintenance");
  set_all(parameters.photons, settings);
  std::vector<Sensor> sensors;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double length = glm::length(directions[i]);
    if (!(length > 0) || !std::isfinite(length)) {
      throw InputError("normals: normal " + std::to_string(i) + " has length 0");
    }
    sensors.push_back({places[i], directions[i] / length});
  }
  const LightMix mix = LightMix::of(*scene, field<double>(options, "lumen_per_watt"));
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
