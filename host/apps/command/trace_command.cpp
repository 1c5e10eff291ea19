#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/saved_maps_option.hpp"
#include "command/scene_options.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "loading/load_scene.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "render/render_plan.hpp"
#include "saved_maps/saved_maps.hpp"

namespace photile::app {
namespace {

struct TraceOptions {
  RenderOptions render;
  std::string output;
};

void run_trace(TraceOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  render.parameters.passes = 1;  // a file holds the photons of one
  check(render.parameters);
  note_inputs_of(render);
  check_outputs(std::vector<std::filesystem::path>{options.output});
  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  tell_scene(scene, LightMix::of(scene, render.load.lumen_per_watt), render.load, progress);

  const RayScene rays(scene);
  const RenderPlan plan(render.parameters, rays, HitsAsk::pictures, progress);
  PhotonTracerResult traced = trace_photons(rays, plan.tracing(0, {}), progress);
  TracedPhotons photons;
  photons.photons = std::move(traced.photons);
  if (plan.gathers_at_nodes()) photons.caustics = std::move(traced.caustics);
  progress.begin("save photons", 0, "");
  saved_maps::save(options.output, scene, saved_settings(render.parameters), photons);
  progress.end();
  progress.note(fmt::format("{}: {} photons", options.output, photons.photons.size()));
}

}  // namespace

void add_trace_command(CLI::App& photile) {
  auto options = std::make_shared<TraceOptions>();
  RenderOptions& render = options->render;
  CLI::App* command =
      photile.add_subcommand("trace", "Trace photons and save them for --load-maps");
  OptionGroup(*command, "Output")
      .add("-o,--output", options->output, "FILE", "file of photons to write")
      ->required();
  add_scene_file(*command, render.scene);
  set_quality(render.quality_options(), Quality::good);
  add_quality_preset(*command, render.quality_options());
  for (const char* name : {"photons_emitted", "seed"}) {
    add_setting(*command, render.parameters, name);
  }
  Settings of_photons = rendering_settings(render.parameters);
  std::erase_if(of_photons, [](const Setting& setting) {
    constexpr std::array kept{"quota", "maps", "direct_rays", "light_maps", "light_map_rays"};
    return std::find(kept.begin(), kept.end(), setting.name) == kept.end();
  });
  add_set_option(*command, {of_photons, scene_settings(render.load)});
  add_scene_options(*command, render.load);
  add_light_options(*command, render.load);
  add_run_group(*command, render);
  command->callback([options] { run_trace(*options); });
}

}  // namespace photile::app
