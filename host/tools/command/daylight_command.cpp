#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "common/ascii_text.hpp"
#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "daylight/annual_daylight.hpp"
#include "daylight/daylight_metrics.hpp"
#include "import/weather_file.hpp"
#include "measuring/measure_grids.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/output_files.hpp"
#include "tools/command/place_options.hpp"
#include "tools/command/render_options.hpp"
#include "tools/command/run_notes.hpp"
#include "tools/command/sensor_options.hpp"
#include "tools/command/signals.hpp"
#include "tools/command/terminal_progress.hpp"
#include "tools/command/threads.hpp"
#include "tools/command/validators.hpp"
#include "tools/report/daylight_tables.hpp"

namespace photile::app {
namespace {

using namespace daylight;
using measuring::GridDaylight;

struct DaylightOptions {
  RenderOptions render;
  MeasuringParameters parameters;
  PlaceOptions places;
  std::vector<std::string> outputs;  ///< .csv, .json
  std::string honeybee;              ///< folder, "" = none
  int patches = defaults::sky_patches;
  double ground = defaults::ground_reflectance;
  std::string suns = "rays";
  measuring::DaylightAsked asked{defaults::daylight_lux, {}};
  std::string occupied = "8-18";
  double lamps_to = 0;  ///< lux that lamps keep; 0 = no lamps
  double lamp_efficacy = defaults::lamp_efficacy;
};

Occupancy parse_occupancy(const std::string& text) {
  const std::size_t dash = text.find('-');
  if (dash != std::string::npos) {
    const auto from = parse_signed(text.substr(0, dash)), to = parse_signed(text.substr(dash + 1));
    if (from && to && *from >= 0 && *from < *to && *to <= 24) return {*from, *to};
  }
  throw UsageError(
      fmt::format("--occupied {}: use FROM-TO, such as 8-18, hours within 0 and 24", text));
}

std::vector<measuring::SensorGrid> grids_of(const DaylightOptions& options, const Scene& scene,
                                            std::size_t hours, Progress& progress) {
  std::vector<measuring::SensorGrid> grids = grids_at(options.places, scene);
  std::size_t sensors = 0;
  for (auto& grid : grids) {
    clear_of_furniture(options.places.plane, scene, grid, progress);
    sensors += grid.sensors.size();
  }
  if (sensors * hours > limits::max_profile_values) {
    throw UsageError(fmt::format("{} points of {} hours are more than {} values; give fewer points",
                                 sensors, hours, limits::max_profile_values));
  }
  return grids;
}

/// What the lamps over a grid use in a year.
std::vector<LampEnergy> energies_of(const DaylightOptions& options, const DaylightMatrix& matrix,
                                    const LightMix& mix, const std::vector<bool>& occupied,
                                    const GridDaylight& grid, std::size_t first) {
  if (!(options.lamps_to > 0) || matrix.lamps.empty()) return {};
  const std::size_t count = grid.grid.sensors.size(), hours = occupied.size();
  std::vector<double> mean(hours, 0.0), of_lamp, watts;
  for (std::size_t i = 0; i < count * hours; ++i)
    mean[i % hours] += double{grid.lux[i]} / static_cast<double>(count);
  for (std::size_t lamp = 0; lamp < matrix.lamps.size(); ++lamp) {
    const float* lux = matrix.from_lamps.data() + lamp * matrix.sensors + first;
    of_lamp.push_back(std::accumulate(lux, lux + count, 0.0) / static_cast<double>(count));
    for (const MixedLight& light : mix.lights) {
      if (light.name != matrix.lamps[lamp]) continue;
      const double lumens = light.power * (light.unit == PowerUnit::lumen ? 1 : mix.lumen_per_watt);
      watts.push_back(lumens / options.lamp_efficacy);
    }
  }
  return lamp_energy(mean, occupied, matrix.lamps, of_lamp, watts, options.lamps_to);
}

std::vector<GridDaylight> results_of(const DaylightOptions& options,
                                     std::vector<measuring::SensorGrid> grids,
                                     const DaylightMatrix& matrix, const AnnualProfile& profile,
                                     const std::vector<SkyHour>& hours, const LightMix& mix) {
  const std::vector<bool> occupied = occupied_hours(hours, options.asked.occupancy);
  const std::vector<bool> by_day = daylight_hours(hours);
  std::vector<GridDaylight> results;
  std::size_t first = 0;
  for (measuring::SensorGrid& grid : grids) {
    GridDaylight result;
    const std::size_t count = grid.sensors.size();
    const auto part = [&](const std::vector<float>& all, std::size_t each) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first * each);
      return all.empty()
                 ? std::vector<float>{}
                 : std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(count * each));
    };
    result.grid = std::move(grid);
    result.lux = part(profile.all, profile.hours);
    result.sun = part(profile.sun, profile.hours);
    result.relative_error = part(matrix.relative_error, 1);
    for (std::size_t sensor = 0; sensor < count; ++sensor) {
      const auto row = [&](const std::vector<float>& all) {
        return all.empty() ? std::span<const float>()
                           : std::span(all).subspan(sensor * profile.hours, profile.hours);
      };
      result.points.push_back(point_daylight(row(result.lux), row(result.sun), occupied, by_day,
                                             options.asked.wanted_lux));
    }
    result.room = room_daylight(result.points);
    result.lamps = energies_of(options, matrix, mix, occupied, result, first);
    first += count;
    results.push_back(std::move(result));
  }
  return results;
}

void write(const DaylightOptions& options, const std::vector<GridDaylight>& results,
           const std::vector<SkyHour>& hours) {
  for (const std::filesystem::path file : options.outputs) {
    write_file(file, file.extension() == ".csv"
                         ? measuring::daylight_csv(results)
                         : measuring::daylight_json(results, options.asked).dump(1) + "\n");
  }
  if (options.honeybee.empty()) return;
  for (const auto& [name, content] : measuring::annual_files(results, hours))
    write_file(std::filesystem::path(options.honeybee) / name, content);
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
}

void run_daylight(DaylightOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check_settings(render);
  check_lights(options);
  options.asked.occupancy = parse_occupancy(options.occupied);
  if (options.places.empty()) {
    throw UsageError("no points; give --plane floor+0.75, --grid FILE or --points FILE");
  }
  note_inputs_of(render);
  note_places(options.places);
  if (!options.honeybee.empty()) make_folder(options.honeybee);
  check_outputs(std::vector<std::filesystem::path>(options.outputs.begin(), options.outputs.end()));

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  scene_io::WeatherYear weather = scene_io::read_weather(render.load.situation.weather);
  if (render.load.situation.site) weather.site = *render.load.situation.site;
  const double north = render.load.situation.north_degrees * std::numbers::pi / 180;
  render.load.sky = Sky{SkyKind::patches, 0, 0, 0, options.patches};
  render.load.situation.weather.clear();
  render.load.situation.site.reset();
  Scene scene = load_scene(render.scene, render.load);
  const LightMix mix = mix_of(scene, render);
  auto grids = grids_of(options, scene, weather.hours.size(), progress);
  std::vector<Device> devices = devices_for(render, progress);
  scene.portals = measuring::portals_of_grids(scene, grids, render.load.portals);
  if (scene.portals.empty()) {
    progress.note(
        "no windows were found: photons of the sky start all around the scene; name the "
        "panes' material by --portals if there are some");
  }

  const std::vector<SkyPatch> patches = sky_patches(options.patches);
  const std::vector<SkyHour> hours = sky_hours(weather, patches, options.ground);
  MatrixParameters parameters{options.parameters, mean_luminances(hours, patches),
                              options.suns == "rays"};
  parameters.measuring.photons = render.parameters;
  std::vector<Sensor> sensors;
  for (const auto& grid : grids)
    sensors.insert(sensors.end(), grid.sensors.begin(), grid.sensors.end());
  const DaylightMatrix matrix =
      daylight_matrix(scene, sensors, mix, patches, devices, parameters, progress);
  std::optional<StraightLight> straight;
  if (parameters.straight) straight.emplace(scene, sensors);
  const AnnualProfile profile =
      annual_profile(matrix, hours, patches, north, options.parameters.maintenance,
                     straight ? &*straight : nullptr);
  const auto results = results_of(options, std::move(grids), matrix, profile, hours, mix);
  write(options, results, hours);
  for (const auto& line : measuring::daylight_lines(results, options.asked))
    std::cout << line << '\n';
}

void add_year(CLI::App& command, DaylightOptions& options) {
  command.add_option("--patches", options.patches, "of the sky: Tregenza's, or Reinhart's")
      ->type_name("")
      ->check(CLI::IsMember({145, 577, 2305}))
      ->capture_default_str()
      ->group("Year");
  command
      .add_option("--suns", options.suns,
                  "rays: the sun's own to each point; patches: the four patches nearest to it, as "
                  "Radiance's two-phase method has it")
      ->type_name("")
      ->check(CLI::IsMember({"rays", "patches"}))
      ->capture_default_str()
      ->group("Year");
  command
      .add_option("--ground", options.ground, "reflectance of the ground that surrounds the scene")
      ->type_name("X")
      ->transform(number_between(0, 1))
      ->capture_default_str()
      ->group("Year");
  command.add_option("--lux", options.asked.wanted_lux, "that count as autonomous daylight")
      ->type_name("LUX")
      ->transform(positive_number())
      ->capture_default_str()
      ->group("Year");
  command.add_option("--occupied", options.occupied, "hours of every day in standard time")
      ->type_name("FROM-TO")
      ->capture_default_str()
      ->group("Year");
  command
      .add_option("--lamps-to", options.lamps_to,
                  "lux that the scene's lamps, dimmed together, keep on the mean of a grid; tells "
                  "their energy")
      ->type_name("LUX")
      ->transform(positive_number())
      ->group("Year");
  command.add_option("--lamp-efficacy", options.lamp_efficacy, "lm/W of the scene's lamps")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->group("Year");
}

}  // namespace

void add_daylight_command(CLI::App& photile) {
  auto options = std::make_shared<DaylightOptions>();
  CLI::App* command = photile.add_subcommand(
      "daylight", "A year of daylight at points: autonomy, glare of the sun, energy of lamps");
  command
      ->add_option("-o,--output", options->outputs,
                   "table of the points: .csv or .json; repeatable")
      ->type_name("FILE")
      ->check(file_ending_in({".csv", ".json"}))
      ->allow_extra_args(false)
      ->group("Output");
  command
      ->add_option("--honeybee", options->honeybee,
                   "folder for <grid>.ill, sun-up-hours.txt and grids_info.json: the lux of every "
                   "hour")
      ->type_name("FOLDER")
      ->group("Output");
  add_place_options(*command, options->places);
  add_year(*command, *options);
  options->parameters.repeats = defaults::daylight_repeats;
  add_maintenance_option(*command, options->parameters, "Measuring");
  add_sensor_options(*command, options->parameters, "Measuring");
  add_setting_options(*command, options->render,
                      {"samples_per_pixel", "direct_rays", "final_gather_rays", "gloss", "quota"});
  command->callback([options] { run_daylight(*options); });
}

}  // namespace photile::app
