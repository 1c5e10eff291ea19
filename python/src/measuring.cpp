// Illuminance at the points of grids.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "arrays.hpp"
#include "common/foreign_text.hpp"
#include "grids.hpp"
#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "measuring/working_plane.hpp"
#include "parts.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "report/record.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

/// What was measured, kept for reports.
struct Measuring {
  SharedScene scene;
  LightMix mix;
  MeasuringParameters parameters;
  measuring::Measurement grids;
  std::vector<std::string> warnings;
};

MeasuringParameters parameters_of_measuring(const py::dict& options, const py::dict& settings) {
  MeasuringParameters parameters;
  parameters.by_paths = is_by_paths(options);
  parameters.gathering.rays = field<int>(options, "rays");
  parameters.gathering.response =
      field<bool>(options, "cylindrical") ? SensorResponse::cylindrical : SensorResponse::planar;
  parameters.repeats = field<int>(options, "repeats");
  parameters.maintenance = field<double>(options, "maintenance");
  set_all(parameters.photons, settings);
  check_measuring(parameters);
  return parameters;
}

std::shared_ptr<Measuring> measure(const SharedScene& scene, const py::list& places,
                                   const py::dict& options, const py::dict& settings,
                                   const py::object& progress) {
  const auto grids = grids_of(places);
  const auto device = field<std::string>(options, "device");
  const auto portals = field<std::vector<std::string>>(options, "portals");
  const MeasuringParameters parameters = parameters_of_measuring(options, settings);
  const LightMix mix = LightMix::of(*scene, field<double>(options, "lumen_per_watt"));
  return run(progress, [&](Progress& told) {
    const bool from_beyond = std::any_of(scene->lights.begin(), scene->lights.end(),
                                         [](const Light& light) { return light.is_distant(); });
    const SharedScene lit = from_beyond ? with_portals(scene, grids, portals) : scene;
    std::vector<std::string> warnings = measuring::doubts_of(*scene, grids);
    for (const std::string& line : warnings) told.warn(line);
    for (const measuring::SensorGrid& grid : grids) {
      if (!grid.remark.empty()) warnings.push_back(grid.name + ": " + grid.remark);
    }
    const measuring::Readings readings =
        with_devices(parameters.by_paths, device, [&](std::span<Device> devices) {
          return measuring::measure_grids(*lit, grids, mix, devices, parameters, told);
        });
    measuring::Measurement measured = measuring::measurement_of(grids, readings);
    measuring::mark_dark_points(measured);
    for (std::string& line : measuring::doubts_of(measured, mix.lights)) {
      told.warn(line);
      warnings.push_back(std::move(line));
    }
    return std::make_shared<Measuring>(
        Measuring{scene, mix, parameters, std::move(measured), std::move(warnings)});
  });
}

/// (light, lux, standard errors) of each light at the points of a grid, all together ("") first.
py::list values_at(const Measuring& measured, std::size_t grid) {
  const measuring::GridValues& values = measured.grids.at(grid);
  py::list list;
  const auto add = [&](const std::string& name, const measuring::LightValues& light) {
    std::vector<double> lux, errors;
    for (const Measured& reading : light.sensors) {
      lux.push_back(reading.value);
      errors.push_back(reading.standard_error);
    }
    const auto count = static_cast<py::ssize_t>(lux.size());
    list.append(py::make_tuple(name, taken<double>(std::move(lux), {count}),
                               taken<double>(std::move(errors), {count})));
  };
  for (const measuring::LightValues& light : values.lights) add(light.light, light);
  // A light alone is all lights together.
  if (measured.mix.lights.size() == 1) add(measured.mix.lights.front().name, values.total());
  return list;
}

/// By the names of the command: (value, standard error).
py::dict statistics_at(const Measuring& measured, std::size_t grid) {
  const measuring::GridStatistics& all = measured.grids.at(grid).total().statistics;
  py::dict row;
  const auto add = [&](const char* name, const Measured& figure) {
    row[name] = py::make_tuple(figure.value, figure.standard_error);
  };
  add("Em", all.mean);
  add("Emin", all.minimum);
  add("Emax", all.maximum);
  add("Uo", all.uniformity);
  add("Ud", all.diversity);
  return row;
}

/// What a report is drawn from, as `photile measure -o NAME.json` writes it.
///   facts   what the scene's sky is, and what the report is asked for beside
py::object record_of(const Measuring& measured, const py::dict& facts) {
  report::MeasureRun run{*measured.scene, measured.mix, measured.parameters};
  run.version = PHOTILE_VERSION;
  run.warnings = measured.warnings;
  run.ground = field<std::optional<double>>(facts, "ground");
  run.sky = field<std::vector<std::pair<std::string, std::string>>>(facts, "sky");
  run.north = field<std::optional<double>>(facts, "north");
  if (const auto target = field<std::string>(facts, "target"); !target.empty()) {
    run.requirement = measuring::parse_requirement(target);
    const double limit = run.requirement->glare;
    const auto rated = field<std::optional<std::tuple<std::string, double, double>>>(facts, "ugr");
    if (rated && limit > 0) {
      const auto& [observer, value, error] = *rated;
      run.glare = measuring::Judgement{observer, "UGR", limit, {value, error}, true};
    }
  }
  std::optional<glm::dvec3> inside;
  if (const auto place = field<std::optional<std::array<double, 3>>>(facts, "inside"))
    inside = glm::dvec3((*place)[0], (*place)[1], (*place)[2]);
  std::string json;
  {
    const Unlocked unlocked;
    run.room = measuring::room_size(*measured.scene, inside);
    auto record = report::run_json(measured.grids, run, "lux");
    record["report"]["colours"] = report::colours_json({.scale = 0});
    json = json_text(record, -1);
  }
  return parsed(json);
}

}  // namespace

void check_measuring(const MeasuringParameters& parameters) {
  if (parameters.repeats < 2 || parameters.repeats > limits::max_repeats) {
    throw UsageError("repeats: '" + std::to_string(parameters.repeats) +
                     "' is not a whole number from 2 to " + std::to_string(limits::max_repeats));
  }
  if (parameters.gathering.rays < 1 || parameters.gathering.rays > limits::max_samples_per_pixel) {
    throw UsageError("rays: '" + std::to_string(parameters.gathering.rays) +
                     "' is not a whole number from 1 to " +
                     std::to_string(limits::max_samples_per_pixel));
  }
  if (!(parameters.maintenance > 0 && parameters.maintenance <= 1)) {
    throw UsageError("maintenance: '" + std::to_string(parameters.maintenance) +
                     "' is not a number above 0, at most 1");
  }
}

void define_measuring(py::module_& module) {
  py::class_<Measuring, std::shared_ptr<Measuring>>(module, "Measurement")
      .def("values", &values_at)
      .def("statistics", &statistics_at)
      .def("record", &record_of);
  module.def("measure", &measure);
}

}  // namespace photile::python
