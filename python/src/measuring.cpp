// Illuminance at the points of grids.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "arrays.hpp"
#include "common/foreign_text.hpp"
#include "grids.hpp"
#include "loading/surroundings.hpp"
#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "measuring/working_plane.hpp"
#include "parts.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "report/daylight_tables.hpp"
#include "report/record.hpp"
#include "scene/light_names.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

/// A scene as it is measured.
struct Lit {
  SharedScene scene;
  LightMix mix;
  std::optional<SceneLoadOptions> overcast = {};  ///< of daylight factors: the sky
  std::string mood = {};
  bool direct = false;  ///< whether surfaces reflect nothing
};

/// What was measured, kept for reports.
struct Measuring {
  Lit lit;
  MeasuringParameters parameters;
  measuring::Measurement grids;
  std::vector<std::string> warnings;
};

/// Under an overcast sky of 100 lux alone, so that lux are daylight factors in per cent. It takes
/// the place of the sky that the scene has.
Lit under_overcast_sky(const SharedScene& scene, double ground, const py::dict& options) {
  SharedScene under = without_sky(scene);
  const std::size_t own = under->lights.size();
  SceneLoadOptions load;
  load.sky = Sky{SkyKind::overcast, 100};
  load.ground = ground;
  loading::add_surroundings(*under, load);
  scene::make_light_names_unique(under->lights);
  for (std::size_t i = own; i < under->lights.size(); ++i) under->lights[i].group.clear();
  LightMix mix = mix_of(*under, options);
  const LightGroups groups = light_groups_of(*under);
  for (std::size_t i = 0; i < own; ++i) mix.lights[groups.group_of[i]].power = 0;
  return {std::move(under), std::move(mix), load};
}

/// Grids without a target of their own get that of the options.
Lit lit_for(const SharedScene& scene, const py::dict& options,
            std::vector<measuring::SensorGrid>& grids) {
  const auto target = field<std::string>(options, "target");
  if (const auto ground = field<std::optional<double>>(options, "daylight_factor_ground")) {
    if (!target.empty()) {
      throw UsageError(
          "target needs lux, and daylight_factor gives per cent; leave out one of them, or rate "
          "the room by EN 17037 with photile.daylight");
    }
    for (measuring::SensorGrid& grid : grids) grid.target.clear();
    return under_overcast_sky(scene, *ground, options);
  }
  for (measuring::SensorGrid& grid : grids) {
    if (grid.target.empty()) grid.target = target;
  }
  Lit lit{scene, mix_of(*scene, options)};
  lit.direct = measuring::are_direct(grids);
  lit.mood = field<std::string>(options, "mood");
  if (lit.direct) {
    auto black = std::make_shared<Scene>(*scene);
    measuring::remove_reflections(*black);
    lit.scene = std::move(black);
  }
  return lit;
}

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
  auto grids = grids_of(places);
  const auto device = field<std::string>(options, "device");
  const auto portals = field<std::vector<std::string>>(options, "portals");
  const MeasuringParameters parameters = parameters_of_measuring(options, settings);
  const Lit lit = lit_for(scene, options, grids);
  return run(progress, [&](Progress& told) {
    const bool from_beyond = std::any_of(lit.scene->lights.begin(), lit.scene->lights.end(),
                                         [](const Light& light) { return light.is_distant(); });
    const SharedScene traced = from_beyond ? with_portals(lit.scene, grids, portals) : lit.scene;
    std::vector<std::string> warnings = measuring::doubts_of(*scene, grids);
    for (const std::string& line : warnings) told.warn(line);
    for (const measuring::SensorGrid& grid : grids) {
      if (!grid.remark.empty()) warnings.push_back(grid.name + ": " + grid.remark);
    }
    const measuring::Readings readings =
        with_devices(parameters.by_paths, device, [&](std::span<Device> devices) {
          return measuring::measure_maintained(*traced, grids, lit.mix, devices, parameters, told);
        });
    measuring::Measurement measured = measuring::measurement_of(grids, readings);
    if (lit.overcast) {
      report::keep_daylight_factors(measured, told);
    } else {
      measuring::mark_dark_points(measured);
      for (std::string& line : measuring::doubts_of(measured, lit.mix.lights)) {
        told.warn(line);
        warnings.push_back(std::move(line));
      }
    }
    return std::make_shared<Measuring>(
        Measuring{lit, parameters, std::move(measured), std::move(warnings)});
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
  if (measured.lit.mix.lights.size() == 1)
    add(measured.lit.mix.lights.front().name, values.total());
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
  const Lit& lit = measured.lit;
  report::MeasureRun run{*lit.scene, lit.mix, measured.parameters};
  run.version = PHOTILE_VERSION;
  run.warnings = measured.warnings;
  run.mood = lit.mood;
  run.ground = field<std::optional<double>>(facts, "ground");
  run.sky = field<std::vector<std::pair<std::string, std::string>>>(facts, "sky");
  run.north = field<std::optional<double>>(facts, "north");
  if (lit.overcast) {
    run.ground = loading::ground_reflectance(*lit.overcast);
    run.sky = loading::sky_facts(*lit.overcast);
    if (!run.north) run.north = 0;
  }
  const auto target = field<std::string>(facts, "target");
  if (lit.overcast && !target.empty())
    throw UsageError("target " + target + ": needs lux, not daylight factors");
  measuring::Measurement grids = measured.grids;
  for (measuring::GridValues& values : grids) {
    if (values.grid.target.empty()) values.grid.target = target;
  }
  using Rated = std::tuple<std::string, std::array<double, 3>, double, double>;
  std::vector<measuring::RatedObserver> observers;
  for (const auto& [name, place, ugr, error] : field<std::vector<Rated>>(facts, "observers")) {
    observers.push_back({name, {place[0], place[1], place[2]}, {ugr, error}});
  }
  run.targets = measuring::judge_targets(grids, observers);
  for (const auto& [requirement, judgements] : run.targets) {
    if (requirement.is_direct == lit.direct) continue;
    throw UsageError("target " + requirement.name +
                     (lit.direct ? ": needs all light, and direct light alone was measured"
                                 : ": is about direct light alone; give it to photile.measure"));
  }
  std::string json;
  {
    const Unlocked unlocked;
    const auto& inside = grids.front().grid.inside;
    const auto is_there = [&](const measuring::GridValues& each) {
      return each.grid.inside == inside;
    };
    if (std::all_of(grids.begin(), grids.end(), is_there))
      run.room = measuring::room_at(*lit.scene, inside);
    const std::string unit = lit.overcast ? "DF %" : "lux";
    auto record = report::run_json(measured.grids, run, unit);
    record["report"]["colours"] = report::colours_json({.scale = 0, .label = unit});
    json = json_text(record, -1);
  }
  return parsed(json);
}

/// What reports state of the settings of a measurement.
py::dict stated(const py::dict& settings) {
  MeasuringParameters parameters;
  set_all(parameters.photons, settings);
  py::dict row;
  row["seed"] = parameters.photons.seed;
  row["photons"] = parameters.photons.photons.emitted_photons;
  row["neighbours"] = parameters.photons.neighbours;
  return row;
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
  module.def("stated", &stated);
  module.def("colours", [] { return parsed(json_text(report::colours_json({}), -1)); });
}

}  // namespace photile::python
