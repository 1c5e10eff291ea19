#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "command/command_line.hpp"
#include "command/daylight_options.hpp"
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
#include "publish/published_room.hpp"
#include "serve/live_luminaires.hpp"
#include "serve/live_room.hpp"
#include "serve/web_server.hpp"
#include "view/moods.hpp"
#include "view/scene_loader.hpp"
#include "view/year_worker.hpp"

namespace photile::app {
namespace {

constexpr auto step_time = std::chrono::milliseconds(4);

constexpr const char* year_plane = "floor+0.85";  // EN 17037
constexpr double year_seconds = 30;               // for which figures of the year are refined

struct ViewOptions {
  RenderOptions render;
  serve::WebAddress address;
  std::string title;  ///< "" = by the scene's file
  bool no_browser = false;
  double keep = 60;  ///< seconds
};

/// Has the desktop show an address. Nothing tells whether it does.
void open_browser(const std::string& url) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  std::string name = "xdg-open", address = url;
  char* const arguments[] = {name.data(), address.data(), nullptr};
  pid_t process = 0;
  posix_spawnp(&process, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
}

/// Lights that options name may not exist any longer by then.
LightMix mix_again(const Scene& scene, const RenderOptions& options) {
  try {
    return mix_of(scene, options);
  } catch (const UsageError&) {
    return LightMix::of(scene, options.load.lumen_per_watt);
  }
}

/// Whether the sky is that of a weather file, so that a year of it can be measured.
bool has_year(const SceneLoadOptions& load) {
  return !load.situation.weather.empty() && !load.sky && !load.sun && load.environment.file.empty();
}

view::YearWorker::Measure year_of(const RenderOptions& render) {
  if (!has_year(render.load)) return {};
  DaylightOptions year;
  year.render = render;
  year.render.load.situation.time.reset();
  year.places.plane = year_plane;
  year.seconds = year_seconds;
  return [year](const auto& tell, Progress& stop) { refine_year(year, tell, stop); };
}

void run_view(ViewOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
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
  const view::YearWorker::Measure measure_year = year_of(render);
  const SkySituation situation = view::take_moving_sky(render.load);
  const loading::SourcedScene sourced =
      loading::load_sourced_scene(render.scene, render.load, progress);
  const Scene& scene = sourced.scene;
  render.mood.edited = true;
  tell_scene(scene, mix_of(scene, render), render.load, progress);
  std::shared_ptr<serve::LiveLuminaires> edited;
  if (!luminaires.empty()) {
    edited =
        std::make_shared<serve::LiveLuminaires>(luminaires, sourced.luminaires, scene, render.load);
  }
  const std::filesystem::path file = render.scene, moods = render.mood.file;
  serve::LiveRoom room(
      scene, [&render] { return open_devices(render.device); },
      {.render = render.parameters,
       .mix_of = [&render](const Scene& loaded) { return mix_again(loaded, render); },
       .camera_of = [&render](const Scene& loaded) { return opening_camera(loaded, render); },
       .load = render.load,
       .situation = situation,
       .prepared = load_maps(scene, render, progress),
       .keep = keep_maps(scene, render, Progress::none()),
       .luminaires = edited,
       .measure_year = measure_year,
       .moods = moods.empty() ? view::Moods::file_of(file) : moods,
       .light_map_bytes = render.device.memory_bytes,
       .white = render.pictures.white.white,
       .white_balance = render.pictures.white_balance,
       .view = render.pictures.tone_mapping.view,
       .title = options.title.empty() ? file.stem().string() : options.title,
       .version = version_number()});
  const serve::WebServer server(
      options.address, [&room](const serve::WebRequest& request) { return room.answer(request); },
      [&room](const serve::WebRequest& request) { return room.listen(request); });
  std::cout << server.url() << std::endl;  // at once, also where it is read by a program
  if (!options.no_browser) open_browser(server.url());
  room.make_page();
  while (!stop_requested() && room.left_alone() < options.keep) {
    room.step();
    std::this_thread::sleep_for(step_time);
  }
  if (edited) edited->tell_unsaved(progress);
  room.finish([&](const LightMapContents& light_maps) {
    if (!render.save_maps.empty()) keep_light_maps(light_maps, render, progress);
  });
}

}  // namespace

void add_view_command(CLI::App& photile) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = photile.add_subcommand(
      "view", "Walk through a scene in a browser while its light is computed, and set its lamps");
  const OptionGroup page(*command, "Page");
  page.call(
          "--listen",
          [options](const std::string& text) { options->address = serve::WebAddress::parse(text); },
          "ADDRESS[:PORT]",
          "IP address that serves the page; unless it is 127.0.0.1, anyone "
          "who has the link can open it")
      ->default_str("127.0.0.1, any port");
  page.flag("--no-browser", options->no_browser, "print only the address");
  page.add("--keep", options->keep, "TIME", "end this long after the last page is closed",
           duration())
      ->default_str("1min");
  page.add("--title", options->title, "TEXT", "title; default: the name of the scene file");
  add_white_option(page, options->render.pictures.white);
  set_quality(options->render.quality_options(), Quality::good);
  add_quality_preset(*command, options->render.quality_options());
  add_setting_options(*command, options->render, {"light_maps"},
                      {display_view_setting(options->render.pictures.tone_mapping),
                       white_balance_setting(options->render.pictures)});
  add_view_options(OptionGroup(*command, "Picture"), options->render);
  add_saved_maps_options(*command, options->render);
  command->callback([options] { run_view(*options); });
}

}  // namespace photile::app
