#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/daylight_options.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/report_contents.hpp"
#include "command/run_record.hpp"
#include "command/sensor_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "loading/load_scene.hpp"
#include "measuring/measurement.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "render/refinement.hpp"
#include "report/honeybee_files.hpp"
#include "report/plan_surroundings.hpp"
#include "report/record.hpp"
#include "weather/weather_file.hpp"

namespace photile::app {
namespace {

using namespace daylight;

/// 1 = there are no blinds.
std::size_t states_of_blinds(const DaylightOptions& options) {
  return options.blinds_are_scene() ? 2 : std::size_t{1} << options.blinds.size();
}

/// The scene's own lamps at the points; daylight leaves them out.
report::YearLamps lamps_of(const DaylightOptions& options, const Scene& scene,
                           std::span<const Sensor> sensors, const LightMix& mix,
                           Progress& progress) {
  if (!(options.lamps_to > 0) || scene.lights.empty()) return {};
  std::vector<Device> devices = devices_for(options.render, progress);
  MeasuringParameters parameters = options.parameters;
  parameters.photons = options.render.parameters;
  return report::year_lamps(scene, sensors, mix, options.lamps_to, options.lamp_efficacy, devices,
                            parameters, progress);
}

/// What a report of the year alone states beside its figures.
nlohmann::ordered_json report_of(const DaylightOptions& options, const Scene& scene,
                                 const nlohmann::ordered_json& grids, std::size_t rounds) {
  nlohmann::ordered_json record{
      {"photile", version_number()},
      {"scene", scene.source.filename().string()},
      {"date", report::today()},
      {"weather", options.render.load.situation.weather.filename().string()},
      {"patches", options.patches},
      {"ground_reflectance", options.asked.ground},
      {"repeats", rounds * static_cast<std::size_t>(options.parameters.repeats)},
      {"rays", options.parameters.gathering.rays},
      {"maintenance_factor", options.parameters.maintenance},
      {"seed", options.render.parameters.seed}};
  record["report"]["subject"] = "A year of daylight";
  record["report"]["colours"] = report::colours_json({});
  record["report"]["included"].push_back({{"file", ""}, {"content", grids}});
  return record;
}

void write(const DaylightOptions& options, const Scene& scene,
           const report::DaylightResults& results, const std::vector<SkyHour>& hours) {
  auto record = report::daylight_json(results, options.asked);
  std::size_t planes = 0;
  const RayScene rays(scene);
  for (std::size_t i = 0; i < results.grids.size() && !options.outputs.empty(); ++i) {
    const auto& layout = results.grids[i].grid.layout;
    if (!layout) continue;
    record[i]["plan"] =
        report::plan_json(rays, *layout, options.render.load.situation.north_degrees);
    ++planes;
  }
  write_results(options.outputs,
                {.csv = [&] { return report::daylight_csv(results, options.asked); },
                 .json = [&] { return json_text(record); },
                 .record = [&] { return report_of(options, scene, record, results.rounds); },
                 .plans = 2 * planes,  // DA and UDI
                 .report = options.report});
  if (options.honeybee.empty()) return;
  write_honeybee(options.honeybee, [&](const std::filesystem::path& scratch) {
    return report::annual_record(results, hours, scratch / "values");
  });
}

/// The lights of the scene are lamps, those from beyond it are the sky's.
void check_lights(const DaylightOptions& options) {
  const SceneLoadOptions& load = options.render.load;
  if (load.sky || load.sun || !load.environment.file.empty() || load.situation.time) {
    throw UsageError(
        "daylight makes the skies of a whole year; leave out --sky, --sun, "
        "--environment and --time");
  }
  if (load.situation.weather.empty()) throw UsageError("daylight needs --weather FILE.epw");
  if (!options.blinds.empty() && options.suns != "rays") {
    throw UsageError("--blinds needs rays to the sun; leave out --suns patches");
  }
  if (options.blinds.size() > most_blind_groups) {
    throw UsageError(
        fmt::format("--blinds: {} groups of panes, more than {}; let some close together",
                    options.blinds.size(), most_blind_groups));
  }
}

/// The sky's lights are needed only to find the windows.
Scene scene_under_sky(const std::string& file, SceneLoadOptions load, const Progress& progress) {
  load.sky = Sky{SkyKind::patches, 0, 0, 0, weather::patch_counts[0]};
  load.ground = defaults::ground_reflectance;  // the year's ground is part of its hours
  load.situation.weather.clear();
  load.situation.site.reset();
  load.portals = {"off"};  // those of the grids' rooms are searched later
  return loading::load_scene(file, load, progress);
}

void take_windows(const DaylightOptions& options, std::span<const measuring::SensorGrid> grids,
                  Scene& scene) {
  scene.portals = measuring::portals_of_grids(scene, grids, options.render.load.portals);
  std::erase_if(scene.lights, [](const Light& light) { return light.is_sky_patch(); });
}

void warn_of_darkness(const SkyRounds& rounds, Progress& progress) {
  // Open ground has pi lux for each cd/m2 of an even sky.
  const auto mean = rounds.mean();
  const daylight::DaylightMatrix& matrix = mean.front().matrix;
  double most = 0;
  for (std::size_t sensor = 0; sensor < matrix.sensors; ++sensor) {
    double lux = 0;
    for (std::size_t i = 0; i < matrix.patches; ++i) lux += matrix.coefficient(sensor, i);
    most = std::max(most, 100 * lux / std::numbers::pi);
  }
  const std::string warning = report::darkness_warning(most);
  if (!warning.empty()) progress.note(warning);
}

std::vector<SkyState> states_of(const DaylightOptions& options, const Year& year, Scene& scene,
                                std::span<const measuring::SensorGrid> grids, Progress& progress) {
  if (options.blinds_are_scene()) {
    Scene closed = scene_under_sky(options.blinds.front(), options.render.load, progress);
    take_windows(options, grids, closed);
    std::vector<SkyState> states{sky_state(year, scene, "open", 0, progress)};
    states.push_back(sky_state(year, closed, "closed", 1, progress));
    return states;
  }
  std::vector<BlindGroup> groups;
  for (const std::string& text : options.blinds) groups.push_back(BlindGroup::parse(text));
  return sky_states(year, scene, groups, progress);
}

/// A scene and what its year is computed from.
struct PreparedYear {
  Year year;
  Scene scene;
  std::vector<measuring::SensorGrid> grids;
};

PreparedYear prepare_year(DaylightOptions& options, Progress& progress) {
  const RenderOptions& render = options.render;
  weather::WeatherYear weather = weather::read_weather(render.load.situation.weather);
  if (render.load.situation.site) weather.site = *render.load.situation.site;
  // Loaded apart: where an initialiser throws, GCC 12 destroys twice what those before it made.
  Scene loaded = scene_under_sky(render.scene, render.load, progress);
  PreparedYear prepared{{{}, weather::sky_patches(options.patches), {}, options.suns == "rays", {}},
                        std::move(loaded),
                        {}};
  auto& [year, scene, grids] = prepared;
  year.hours = sky_hours(weather, year.patches, render.load.ground);
  options.asked.ground = render.load.ground;
  options.asked.occupied = occupied_hours(year.hours, options.asked.occupancy);
  find_rooms(options.places, scene);
  grids = measuring::grids_at(scene, options.places, progress);
  std::size_t sensors = 0;
  for (const measuring::SensorGrid& grid : grids) sensors += grid.sensors.size();
  const std::size_t hours = weather.hours.size(), states = states_of_blinds(options);
  if (sensors * hours * states > limits::max_profile_values) {
    throw UsageError(
        fmt::format("{} points of {} hours in {} states are more than {} values; give "
                    "fewer points",
                    sensors, hours, states, limits::max_profile_values));
  }
  take_windows(options, grids, scene);
  if (scene.portals.empty()) {
    progress.note(
        "no windows were found, so rays search for the sky in all directions; if there are "
        "windows, name the material of their panes by --set portals=GLOB");
  }
  for (const auto& grid : grids)
    year.sensors.insert(year.sensors.end(), grid.sensors.begin(), grid.sensors.end());
  year.parameters = {options.parameters,
                     render.load.situation.north_degrees * std::numbers::pi / 180,
                     mean_luminances(year.hours, year.patches)};
  year.parameters.measuring.photons = render.parameters;
  return prepared;
}

/// Rounds of rays, each of which is a part of the work.
///   told   after the first, second, fourth, eighth and so on
SkyRounds rounds_of(const DaylightOptions& options, PreparedYear& prepared,
                    const std::function<double()>& elapsed,
                    const std::function<void(const SkyRounds&)>& told, Progress& progress) {
  constexpr int fewest = 4;  // in the shortest time, for an error
  SkyRounds rounds;
  const auto add = [&](int, Progress& deadline) {
    QuietProgress quiet(deadline);
    Progress& telling = rounds.count() == 0 ? deadline : quiet;
    rounds.add(states_of(options, rounds.year_of_next(prepared.year), prepared.scene,
                         prepared.grids, telling));
    return 0.0;
  };
  const auto finished = [&](int round, double) {
    if (round == 1) warn_of_darkness(rounds, progress);
    if (std::has_single_bit(rounds.count())) told(rounds);
  };
  refine({.seconds = options.seconds, .parts = options.seconds > 0 ? fewest : 1},
         {.add = add,
          .finished = finished,
          .elapsed = elapsed,
          .next = [](int parts) { return parts + 1; },
          .work = [](int parts) { return static_cast<double>(parts); }},
         progress);
  return rounds;
}

void run_daylight(DaylightOptions& options) {
  const Stopwatch watch;
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
  check_lights(options);
  options.asked.occupancy.set_hours(options.occupied);
  options.asked.occupancy.set_days(options.days);
  options.asked.occupancy.schedule = options.schedule;
  if (options.places.empty()) {
    throw UsageError("no points; give --plane floor+0.75, --grid FILE or --points FILE");
  }
  note_inputs_of(render);
  note_places(options.places);
  if (options.blinds_are_scene()) note_input(options.blinds.front());
  if (!options.schedule.empty()) note_input(options.schedule);
  if (!options.honeybee.empty()) {
    check_honeybee();
    make_folder(options.honeybee);
  }
  check_outputs(std::vector<std::filesystem::path>(options.outputs.begin(), options.outputs.end()));
  check_report(options.report, options.outputs);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  PreparedYear prepared = prepare_year(options, progress);
  const auto& [year, scene, grids] = prepared;
  if (!options.honeybee.empty()) {
    const std::filesystem::path folder = options.honeybee;
    for (const std::string& name : report::annual_names(grids, states_of_blinds(options))) {
      note_output(folder / name);
    }
  }
  note_plans(options.outputs, 2 * planes_of(grids));  // DA and UDI
  const LightMix mix = mix_of(scene, render);
  const auto told = [&](const SkyRounds& rounds) {
    if (rounds.count() == 1) return;
    const auto results = daylight_results(options.asked, prepared.year, prepared.grids, rounds);
    for (const report::GridDaylight& grid : results.grids) {
      progress.note(fmt::format("{}, {} rounds: {}: {}", format_seconds(watch.seconds()),
                                rounds.count(), grid.grid.name,
                                report::autonomy_text(grid, options.asked, rounds.count())));
    }
  };
  const SkyRounds rounds = rounds_of(
      options, prepared, [&] { return watch.seconds(); }, told, progress);
  const auto lamps = lamps_of(options, scene, year.sensors, mix, progress);
  const report::DaylightResults results =
      daylight_results(options.asked, year, grids, rounds, lamps);
  write(options, scene, results, year.hours);
  for (const auto& line : report::daylight_lines(results, options.asked)) std::cout << line << '\n';
}

void add_year(CLI::App& command, DaylightOptions& options) {
  const OptionGroup year(command, "Year");
  year.add("--patches", options.patches, "", "number of sky patches: Tregenza's, or Reinhart's",
           CLI::IsMember({145, 577, 2305}))
      ->capture_default_str();
  year.add("--suns", options.suns, "",
           "rays: from each point to the sun; patches: the sun's light comes from the four nearest "
           "patches, as in Radiance's two-phase method",
           CLI::IsMember({"rays", "patches"}))
      ->capture_default_str();
  year.add("--lux", options.asked.target_lux, "LUX",
           "illuminance that daylight has to provide (DA, sDA), lux", positive_number())
      ->capture_default_str();
  year.add("--occupied", options.occupied, "FROM-TO", "occupied hours of the day, standard time")
      ->capture_default_str();
  year.add("--days", options.days, "DAYS",
           "occupied days of the week, by the calendar of the weather file")
      ->capture_default_str();
  year.add(
      "--schedule", options.schedule, "FILE.csv",
      "replaces --occupied and --days: a value for each hour of the year, occupied if above 0");
  year.repeat("--blinds", options.blinds, "SCENE|MATERIAL=TRANSMITTANCE",
              "blinds that close when the sun shines in (IES LM-83): the scene with closed blinds, "
              "or the material of panes and their transmittance behind closed blinds; repeatable");
  year.add("--lamps-to", options.lamps_to, "LUX",
           "mean illuminance of a grid that the scene's lamps, dimmed together, maintain, lux; "
           "adds their energy to the results",
           positive_number());
  year.add("--lamp-efficacy", options.lamp_efficacy, "X",
           "luminous efficacy of lamps whose photometric files state no power, lm/W",
           positive_number())
      ->capture_default_str();
}

}  // namespace

void refine_year(DaylightOptions options, const std::function<void(std::vector<std::string>)>& tell,
                 Progress& progress) {
  const Stopwatch watch;
  options.asked.occupancy.set_hours(options.occupied);
  options.asked.occupancy.set_days(options.days);
  QuietProgress quiet(progress);
  PreparedYear prepared = prepare_year(options, quiet);
  const auto told = [&](const SkyRounds& rounds) {
    tell(report::daylight_lines(
        daylight_results(options.asked, prepared.year, prepared.grids, rounds), options.asked));
  };
  rounds_of(
      options, prepared, [&] { return watch.seconds(); }, told, quiet);
}

void add_daylight_command(CLI::App& photile) {
  auto options = std::make_shared<DaylightOptions>();
  CLI::App* command = photile.add_subcommand(
      "daylight", "Assess a year of daylight at points: autonomy, sun exposure, energy of lamps");
  const OptionGroup output(*command, "Output"), measuring(*command, "Measuring");
  output.repeat("-o,--output", options->outputs, "FILE",
                "table of the points (.csv, .json), plans of DA and UDI (.svg) or a report (.html, "
                ".pdf); repeatable",
                file_ending_in({".csv", ".json", ".svg", ".html", ".pdf"}));
  output.add("--honeybee", options->honeybee, "FOLDER",
             "folder for the lux of every hour, in the format of Honeybee's annual recipes");
  add_template_option(output, options->report);
  add_place_options(*command, options->places);
  add_year(*command, *options);
  add_maintenance_option(measuring, options->parameters);
  add_sensor_options(measuring, options->parameters);
  measuring.add("--for", options->seconds, "TIME",
                "add rounds of rays for this time; results get standard errors, and sDA states "
                "whether it certainly meets 55% or 75%",
                duration());
  add_setting_options(*command, options->render,
                      {"samples_per_pixel", "direct_rays", "gloss", "quota"});
  command->callback([options] { run_daylight(*options); });
}

}  // namespace photile::app
