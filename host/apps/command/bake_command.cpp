#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bake/write_baked.hpp"
#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/quality_options.hpp"
#include "command/render_options.hpp"
#include "command/saved_maps_option.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "loading/load_scene.hpp"
#include "photile/limits.hpp"
#include "render/render_session.hpp"

namespace photile::app {
namespace {

struct BakeOptions {
  RenderOptions render;
  std::string output;
  bake::BakeParameters baking;
};

void run_bake(BakeOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  render.parameters.light_maps = LightMapMode::on;
  check(render.parameters);
  note_inputs_of(render);
  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  check_outputs(bake::files_of(options.output, scene, mix));
  std::vector<Device> devices = devices_for(render, progress);
  tell_scene(scene, mix, render.load, progress);

  std::optional<TracedPhotons> prepared = load_maps(scene, render, progress);
  const auto prepared_scene = std::make_shared<const PreparedScene>(scene);
  options.baking.open = bake::open_sides(prepared_scene->rays);
  RenderSession session(prepared_scene, devices, render.parameters, progress);
  session.keep_passes(prepared ? &*prepared : nullptr, keep_maps(scene, render, progress),
                      progress);
  cache::SurfaceCache& cache = *session.light().cache();
  for (const MixedLight& light : mix.lights)
    options.baking.powers.push_back(mix.power_in_picture(light));
  const bake::BakedLight baked(scene, cache.maps(), options.baking, progress);
  bake::write_baked(options.output, scene, baked, mix);
  keep_light_maps(session.light_map_contents(), render, progress);
  progress.note(fmt::format("{}: {} x {} texels, {:.3g} cm apart", options.output, baked.width(),
                            baked.height(), 100 * baked.texel()));
}

}  // namespace

void add_bake_command(CLI::App& photile) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = photile.add_subcommand(
      "bake", "Bake light maps into textures of a glTF scene, one picture per light");
  const OptionGroup output(*command, "Output");
  output
      .add("-o,--output", options->output, "FILE.gltf",
           "scene to write; its buffers and pictures lie beside it",
           file_ending_in({".gltf", ".glb"}))
      ->required();
  output.add("--texel", options->baking.texel, "M",
             "distance between texels, m; default: half that of the coarsest nodes, or what fits",
             positive_number());
  output
      .add("--most-texels", options->baking.most_side, "N",
           "largest width and height of the pictures, texels",
           count_between(64, limits::max_image_side))
      ->capture_default_str();
  set_quality(options->render.quality_options(), Quality::good);
  add_quality_preset(*command, options->render.quality_options());
  add_setting_options(*command, options->render,
                      {"samples_per_pixel", "passes", "direct_rays", "light_maps"});
  add_saved_maps_options(*command, options->render);
  command->callback([options] { run_bake(*options); });
}

}  // namespace photile::app
