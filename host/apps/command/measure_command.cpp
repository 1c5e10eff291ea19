#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/command_line.hpp"
#include "command/measure_outputs.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/report_contents.hpp"
#include "command/scene_report.hpp"
#include "command/sensor_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "loading/load_scene.hpp"
#include "loading/surroundings.hpp"
#include "measuring/measurement.hpp"
#include "measuring/requirements.hpp"
#include "measuring/sensor_grid.hpp"
#include "measuring/working_plane.hpp"
#include "photile/errors.hpp"
#include "report/daylight_tables.hpp"
#include "report/tables.hpp"

namespace photile::app {
namespace {

struct MeasureOptions {
  RenderOptions render;
  MeasureOutputOptions outputs;
  MeasuringParameters parameters;
  PlaceOptions places;
  ObserverOptions observers;
  std::string target;  ///< "" = none
  bool cylindrical = false;
  bool daylight_factor = false;
};

/// An overcast sky of 100 lux, so that lux are daylight factors in per cent. Errors: UsageError
/// where another sky is asked for.
void take_overcast_sky(SceneLoadOptions& load) {
  if (load.sky || load.sun || load.situation.time || !load.environment.file.empty()) {
    throw UsageError(
        "--daylight-factor uses the CIE overcast sky; leave out --sky, --sun, --time and "
        "--environment");
  }
  load.sky = Sky{SkyKind::overcast, 100};
}

/// Turns off all lights but the sky and the ground that it lights, which the scene has last.
LightMix mix_of_sky(const SceneLoadOptions& load, Scene& scene, const RenderOptions& render) {
  const std::size_t own = scene.lights.size() - (load.ground > 0 ? 2 : 1);
  for (std::size_t i = own; i < scene.lights.size(); ++i) scene.lights[i].group.clear();
  LightMix mix = mix_of(scene, render);
  const LightGroups groups = light_groups_of(scene);
  for (std::size_t i = 0; i < own; ++i) mix.lights[groups.group_of[i]].power = 0;
  return mix;
}

/// Degrees clockwise from -z where the sky, the names of walls or the setting state it.
std::optional<double> north_of(const MeasureOptions& options) {
  const SceneLoadOptions& load = options.render.load;
  const double north = load.situation.north_degrees;
  const bool stated =
      north != 0 || load.sky || load.sun || load.situation.time || options.places.walls;
  return stated ? std::optional(north) : std::nullopt;
}

/// UGR, of new luminaires.
std::vector<glare::ObserverGlare> rate(std::span<const glare::Observer> observers,
                                       const Scene& scene, const LightMix& mix,
                                       std::span<Device> devices,
                                       const MeasuringParameters& measuring, Progress& progress) {
  if (observers.empty()) return {};
  glare::GlareParameters parameters;
  parameters.by_pictures = false;
  parameters.measuring = measuring;
  parameters.measuring.gathering.response = SensorResponse::planar;
  parameters.measuring.maintenance = 1;
  const double coverage =
      glare::coverage_by_luminaires(scene, observers.front(), parameters.samples);
  return glare::measure_glare(scene, observers, mix, coverage, devices, parameters, {}, progress);
}

void run_measure(const CLI::App& command, MeasureOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
  if (render.integrator == Integrator::path) refuse_photon_map_options(command);
  share_rendering(render);
  if (options.places.empty()) {
    throw UsageError("nothing to measure; give --plane floor+0.75, --grid FILE or --points FILE");
  }
  measuring::parse_requirement(options.target);
  if (options.daylight_factor && !(options.target.empty() && options.observers.empty())) {
    throw UsageError(
        "--target and UGR are about lamps, and --daylight-factor about the sky; leave out one of "
        "them, or rate the room by EN 17037 with photile daylight");
  }
  if (options.daylight_factor) take_overcast_sky(render.load);
  note_inputs_of(render);
  note_places(options.places);
  for (const auto& file : options.observers.files) note_input(file);
  options.outputs.daylight_factor = options.daylight_factor;
  const MeasureOutputs outputs(options.outputs);

  const std::filesystem::path moods = moods_of_report(render.mood.file, render.scene);
  outputs.check_moods(moods);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet || !leads());
  Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix =
      options.daylight_factor ? mix_of_sky(render.load, scene, render) : mix_of(scene, render);
  tell_scene(scene, mix, render.load, progress);
  options.places.layout.north = render.load.situation.north_degrees;
  find_rooms(options.places, scene);
  std::vector<measuring::SensorGrid> grids = measuring::grids_at(scene, options.places, progress);
  for (measuring::SensorGrid& grid : grids) {
    if (grid.target.empty() || options.daylight_factor) grid.target = options.target;
  }
  if (measuring::are_direct(grids)) {
    if (!options.observers.empty()) {
      throw UsageError(
          "targets of emergency lighting have no UGR; leave out --observers and --ugr-at, or the "
          "target");
    }
    measuring::remove_reflections(scene);
  }
  std::optional<measuring::PlaneLayout> eyes;
  const std::vector<glare::Observer> observers =
      observers_at(options.observers, options.places, scene, eyes, progress);
  outputs.check_names(grids);
  scene.portals = measuring::portals_of_grids(scene, grids, render.load.portals);
  std::vector<Device> devices = devices_for(render, progress);
  std::vector<std::string> warnings = doubts_of(scene, mix);
  for (auto& line : measuring::doubts_of(scene, grids)) warnings.push_back(std::move(line));
  for (const std::string& line : warnings) progress.warn(line);
  for (const measuring::SensorGrid& grid : grids) {
    if (!grid.remark.empty()) warnings.push_back(fmt::format("{}: {}", grid.name, grid.remark));
  }

  MeasuringParameters& parameters = options.parameters;
  parameters.photons = render.parameters;
  parameters.by_paths = render.integrator == Integrator::path;
  if (options.cylindrical) parameters.gathering.response = SensorResponse::cylindrical;
  const measuring::Readings readings =
      measuring::measure_maintained(scene, grids, mix, devices, parameters, progress);
  const std::vector<glare::ObserverGlare> rated =
      rate(observers, scene, mix, devices, parameters, progress);
  if (!leads()) return;
  measuring::Measurement measurement = measuring::measurement_of(grids, readings);
  if (options.daylight_factor) {
    report::keep_daylight_factors(measurement, progress);
  } else {
    measuring::mark_dark_points(measurement);
    for (std::string& line : measuring::doubts_of(measurement, mix.lights)) {
      progress.warn(line);
      warnings.push_back(std::move(line));
    }
  }
  outputs.check_picture(scene, progress);
  nlohmann::ordered_json rooms;
  for (const measuring::NamedRoom& room : options.places.rooms) rooms.emplace_back(room.facts);
  if (!rooms.empty()) options.outputs.report.included.push_back({{"file", ""}, {"content", rooms}});
  nlohmann::ordered_json glare, results = options.outputs.report.included;
  if (!rated.empty()) {
    glare = report::glare_record(scene, rated, eyes);
    results.push_back({{"content", glare}});
  }
  const auto targets = measuring::judge_targets(measurement, observers_in(results));
  outputs.write(measurement,
                {scene, mix, parameters, render.mood.mood, targets, glare,
                 outputs.any_record() && options.places.rooms.size() < 2
                     ? measuring::room_at(scene, options.places.layout.inside)
                     : std::nullopt,
                 loading::ground_reflectance(render.load), loading::sky_facts(render.load),
                 std::move(warnings), north_of(options), version_number()},
                moods);
  for (const auto& line : report::measurement_lines(measurement, outputs.unit())) {
    std::cout << line << '\n';
  }
  if (!rated.empty()) {
    for (const auto& line : report::glare_lines(rated)) std::cout << line << '\n';
  }
  for (const auto& line : sky_lines(render.load)) std::cout << line << '\n';
  for (const auto& line : measuring::requirement_lines(targets)) std::cout << line << '\n';
}

void add_places(CLI::App& command, MeasureOptions& options) {
  add_place_options(command, options.places);
  const OptionGroup places(command, "Places");
  places.flag("--walls", options.places.walls, "a grid on each wall of the room");
  places.flag("--ceiling", options.places.ceiling, "a grid on the ceiling of the room");
  places.add("--cylindrical-at", options.places.cylindrical, "HEIGHT",
             "cylindrical illuminance at this height: floor+1.2 for people who sit");
  places.add("--semi-cylindrical-at", options.places.semi_cylindrical, "HEIGHT",
             "semi-cylindrical illuminance at this height, towards four sides");
  add_observers_option(places, options.observers);
  places.add("--ugr-at", options.observers.height, "HEIGHT",
             "UGR of people whose eyes are at this height over the floor, towards four sides");
}

void add_measuring(CLI::App& command, MeasureOptions& options) {
  const OptionGroup measuring(command, "Measuring");
  measuring.flag("--cylindrical", options.cylindrical,
                 "cylindrical illuminance around the direction of each point, which must point up");
  measuring.flag("--daylight-factor", options.daylight_factor,
                 "per cent of the illuminance on open ground under the CIE overcast sky");
  measuring.add("--target", options.target, "NAME|VALUES",
                "requirements of grids whose file names none, by name (office-desk: EN 12464-1; "
                "escape-route: EN 1838, by direct light alone) or values (Em=500,Uo=0.6)");
  add_maintenance_option(measuring, options.parameters, &options.outputs.maintenance);
  add_sensor_options(measuring, options.parameters);
}

}  // namespace

void add_measure_command(CLI::App& photile) {
  auto options = std::make_shared<MeasureOptions>();
  CLI::App* command = photile.add_subcommand(
      "measure", "Measure illuminance at points, in lux, with standard errors");
  add_measure_output_options(*command, options->outputs);
  add_places(*command, *options);
  add_measuring(*command, *options);
  add_setting_options(*command, options->render, {"samples_per_pixel", "direct_rays", "gloss"});
  add_integrator_option(*command, options->render);
  command->callback([command, options] { run_measure(*command, *options); });
}

}  // namespace photile::app
