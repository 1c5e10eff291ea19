#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bake/open_sides.hpp"
#include "cache/charts.hpp"
#include "command/command_line.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/quality_options.hpp"
#include "command/render_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "command/validators.hpp"
#include "common/files.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "publish/published_room.hpp"
#include "render/render_session.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

struct PublishOptions {
  RenderOptions render;
  std::string output;
  std::string title;  ///< "" = by the scene's file
  bake::BakeParameters baking;
};

/// The lights as the page opens with them, then those of the scene's moods.
std::vector<publish::Preset> presets_of(const RenderOptions& options, const LightMix& mix) {
  std::vector<publish::Preset> presets{{"As published", mix}};
  std::filesystem::path file = options.mood.file;
  if (file.empty()) file = view::Moods::file_of(options.scene);
  if (!std::filesystem::exists(file)) return presets;
  note_input(file);
  const view::Moods moods(file);
  for (const std::string& name : moods.names()) {
    LightMix changed = mix;
    change_lights(changed, moods.changes(name, mix));
    presets.push_back({name, changed});
  }
  return presets;
}

void run_publish(PublishOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  render.parameters.light_maps = LightMapMode::on;
  check(render.parameters);
  note_inputs_of(render);
  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  const std::filesystem::path file = options.output;
  check_outputs(std::vector{file});
  std::vector<publish::Preset> presets = presets_of(render, mix);
  publish::SkyHours hours = publish::sky_hours(mix, render.load.situation);
  std::vector<Device> devices = devices_for(render, progress);
  tell_scene(scene, mix, progress);

  const auto prepared_scene = std::make_shared<const PreparedScene>(scene);
  options.baking.open = bake::open_sides(prepared_scene->rays);
  RenderSession session(prepared_scene, devices, render.parameters, nullptr, {}, progress);
  cache::SurfaceCache& cache = *session.light().cache();
  if (!options.baking.exact) {  // in a small room finer, as nodes are
    options.baking.texel = std::min(defaults::published_texel, cache.maps().charts().spacing() / 2);
  }
  for (const MixedLight& light : mix.lights) options.baking.powers.push_back(light.power);
  options.baking.most_texels =
      limits::max_published_texels / std::max<std::size_t>(1, mix.lights.size());
  const bake::BakedLight baked(scene, cache.maps(), session.light().nodes(), cache.sight(),
                               options.baking, progress);

  progress.begin("write the page", 0, "");
  const cache::GatheredNodes* gathered = session.light().gathered();
  const Estimates errors = gathered ? gathered->errors() : Estimates{};
  publish::write_page(
      file, {.scene = scene,
             .baked = baked,
             .mix = mix,
             .node_errors = gathered ? &errors : nullptr,
             .relative_error = 1 / std::sqrt(static_cast<double>(render.parameters.neighbours)),
             .presets = std::move(presets),
             .hours = std::move(hours),
             .title = options.title.empty() ? std::filesystem::path(render.scene).stem().string()
                                            : options.title,
             .version = std::string(version_number())});
  progress.end();
  progress.note(fmt::format("{}: {:.3g} MB, {} lights, {} x {} texels, {:.3g} cm apart",
                            options.output,
                            static_cast<double>(std::filesystem::file_size(file)) / 1e6,
                            mix.lights.size(), baked.width(), baked.height(), 100 * baked.texel()));
}

}  // namespace

void add_publish_command(CLI::App& photile) {
  auto options = std::make_shared<PublishOptions>();
  options->baking.exact = false;
  CLI::App* command = photile.add_subcommand(
      "publish", "Write a page in which anybody walks through the room and turns its lights");
  command->add_option("-o,--output", options->output, "page to write, one file")
      ->required()
      ->type_name("FILE.html")
      ->check(file_ending_in({".html"}))
      ->group("Output");
  command
      ->add_option("--title", options->title, "of the page; default: the name of the scene's file")
      ->type_name("TEXT")
      ->group("Output");
  command
      ->add_option_function<double>(
          "--texel",
          [options](double metres) {
            options->baking.texel = metres;
            options->baking.exact = true;
          },
          fmt::format("metres between texels of the light maps; default: {}, or what fits",
                      defaults::published_texel))
      ->type_name("M")
      ->transform(positive_number())
      ->group("Output");
  set_quality(options->render.quality_options(), Quality::good);
  add_quality_preset(*command, options->render.quality_options());
  add_setting_options(*command, options->render,
                      {"samples_per_pixel", "passes", "direct_rays", "light_maps"});
  command->callback([options] { run_publish(*options); });
}

}  // namespace photile::app
