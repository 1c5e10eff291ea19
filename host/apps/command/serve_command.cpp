#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "serve/live_room.hpp"
#include "serve/web_server.hpp"
#include "view/moods.hpp"
#include "view/moving_sky.hpp"

namespace photile::app {
namespace {

constexpr auto step_time = std::chrono::milliseconds(4);
/// By which the priority is lowered: what is drawn in the browser goes before what is computed.
constexpr int lowered_priority = 10;

struct ServeOptions {
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

void run_serve(ServeOptions& options) {
  handle_signals();
  [[maybe_unused]] const int priority = nice(lowered_priority);
  RenderOptions& render = options.render;
  check(render.parameters);
  note_inputs_of(render);
  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const SkySituation situation = view::take_moving_sky(render.load);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  render.mood.edited = true;
  const LightMix mix = mix_of(scene, render);
  tell_scene(scene, mix, render.load, progress);
  const std::filesystem::path file = render.scene, moods = render.mood.file;
  serve::LiveRoom room(scene, mix, [&render] { return open_devices(render.device); },
                       {.render = render.parameters,
                        .situation = situation,
                        .moods = moods.empty() ? view::Moods::file_of(file) : moods,
                        .light_map_bytes = render.device.memory_bytes,
                        .white = render.pictures.white.white,
                        .white_balance = render.pictures.white_balance,
                        .view = render.pictures.tone_mapping.view,
                        .title = options.title.empty() ? file.stem().string() : options.title,
                        .version = version_number()});
  const serve::WebServer server(
      options.address, [&room](const serve::WebRequest& request) { return room.answer(request); },
      [&room](const std::string& viewer) { return room.listen(viewer); });
  std::cout << server.url() << std::endl;  // at once, also where it is read by a program
  if (!options.no_browser) open_browser(server.url());
  room.make_page();
  while (!stop_requested() && room.left_alone() < options.keep) {
    room.step();
    std::this_thread::sleep_for(step_time);
  }
  throw_if_stop_requested();
}

}  // namespace

void add_serve_command(CLI::App& photile) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command = photile.add_subcommand(
      "serve", "Walk through a scene in a browser while its light is computed, and set its lamps");
  const OptionGroup page(*command, "Page");
  page.call(
          "--listen",
          [options](const std::string& text) { options->address = serve::WebAddress::parse(text); },
          "ADDRESS[:PORT]",
          "numbers that the page is served at; others than 127.0.0.1 let in "
          "whoever has the address of the page")
      ->default_str("127.0.0.1, any port");
  page.flag("--no-browser", options->no_browser, "print the address alone");
  page.add("--keep", options->keep, "TIME", "end so long after the last page was closed",
           duration())
      ->default_str("1min");
  page.add("--title", options->title, "TEXT", "of the page; default: the name of the scene's file");
  add_white_option(page, options->render.pictures.white);
  set_quality(options->render.quality_options(), Quality::good);
  add_quality_preset(*command, options->render.quality_options());
  add_setting_options(*command, options->render, {"light_maps"},
                      {display_view_setting(options->render.pictures.tone_mapping),
                       white_balance_setting(options->render.pictures)});
  command->callback([options] { run_serve(*options); });
}

}  // namespace photile::app
