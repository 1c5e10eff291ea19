#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "command/command_line.hpp"
#include "command/daylight_results.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/saved_maps_option.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "view/moving_sky.hpp"
#include "view/viewer.hpp"

namespace photile::app {
namespace {

struct ViewOptions {
  RenderOptions render;
  double frames_per_second = defaults::view_frames_per_second;
  std::string outputs = ".";
};

/// Lights that options name may not exist any longer by then.
LightMix mix_again(const Scene& scene, const RenderOptions& options) {
  try {
    return mix_of(scene, options);
  } catch (const UsageError&) {
    return LightMix::of(scene, options.load.lumen_per_watt);
  }
}

constexpr const char* year_plane = "floor+0.85";  // EN 17037
constexpr double year_seconds = 30;               // for which figures of the year are refined

/// Whether the sky is that of a weather file, so that a year of it can be measured.
bool has_year(const SceneLoadOptions& load) {
  return !load.situation.weather.empty() && !load.sky && !load.sun && load.environment.file.empty();
}

void run_view(ViewOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
  if (!std::filesystem::is_directory(options.outputs)) {
    throw UsageError(fmt::format("{}: is not a folder; create it, or give another with --outputs",
                                 options.outputs));
  }
  // The file may be written, and a new one does not exist yet.
  const std::filesystem::path luminaires = std::exchange(render.load.luminaires, {});
  note_inputs_of(render);
  if (!luminaires.empty()) {
    render.load.luminaires = luminaires;
    render.load.luminaires_text = loading::read_own_luminaires(luminaires).text();
  }
  if (!render.save_maps.empty()) {
    const std::filesystem::path file = render.save_maps;
    check_outputs(std::span(&file, 1));
  }

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  view::YearWorker::Measure measure_year;
  if (has_year(render.load)) {
    DaylightOptions year;
    year.render = render;
    year.render.load.situation.time.reset();
    year.places.plane.height = year_plane;
    year.seconds = year_seconds;
    measure_year = [year](const auto& tell, Progress& stop) { refine_year(year, tell, stop); };
  }
  const SkySituation situation = view::take_moving_sky(render.load);
  const loading::SourcedScene sourced =
      loading::load_sourced_scene(render.scene, render.load, progress);
  const Scene& scene = sourced.scene;
  render.mood.edited = true;
  const LightMix mix = mix_of(scene, render);
  const Camera camera = camera_of(scene, render);
  set_film_size(render.parameters.film, render.size, camera);
  tell_scene(scene, mix, render.load, progress);

  view::ViewerParameters parameters;
  parameters.render = render.parameters;
  parameters.frames_per_second = options.frames_per_second;
  parameters.outputs = options.outputs;
  parameters.view = render.pictures.tone_mapping.view;
  parameters.fills_screen = render.size.empty();
  parameters.white = render.pictures.white.white;
  parameters.white_balance = render.pictures.white_balance;
  parameters.moods = render.mood.file;
  parameters.prepared = load_maps(scene, render, progress);
  // Progress is shown in the window from here on.
  parameters.keep = keep_maps(scene, render, Progress::none());
  parameters.keep_light_maps = [&](const LightMapContents& light_maps) {
    keep_light_maps(light_maps, render, progress);
  };
  parameters.light_map_bytes = render.device.memory_bytes;
  parameters.load = render.load;
  parameters.situation = situation;
  parameters.mix_of = [&](const Scene& edited) { return mix_again(edited, render); };
  parameters.luminaire_file = luminaires;
  parameters.luminaires = sourced.luminaires;
  parameters.measure_year = std::move(measure_year);
  parameters.notes = &progress;
  parameters.interrupted = [&progress] { return progress.cancelled(); };
  view::run_viewer(
      scene, camera, mix, [&render] { return open_devices(render.device); }, std::move(parameters));
  throw_if_stop_requested();
}

}  // namespace

void add_view_command(CLI::App& photile) {
  auto options = std::make_shared<ViewOptions>();
  set_quality(options->render.quality_options(), Quality::good);
  CLI::App* command =
      photile.add_subcommand("view", "Walk through a scene in a window, and set its lamps");
  const OptionGroup window(*command, "Window");
  window
      .add("--frame-rate", options->frames_per_second, "X",
           "frames per second to reach while moving; pictures become smaller where needed",
           positive_number())
      ->capture_default_str();
  window.add("--outputs", options->outputs, "FOLDER", "folder for what F12 and Ctrl+S save")
      ->capture_default_str();
  add_white_option(window, options->render.pictures.white);
  add_picture_settings(*command, options->render,
                       {display_view_setting(options->render.pictures.tone_mapping),
                        white_balance_setting(options->render.pictures)});
  command->get_option("--size")->description(
      "pixels of the picture; default: the window takes most of the screen");
  add_saved_maps_options(*command, options->render);
  command->callback([options] { run_view(*options); });
}

}  // namespace photile::app
