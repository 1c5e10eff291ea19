#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/write_baked.hpp"
#include "cache/charts.hpp"
#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/quality_options.hpp"
#include "command/render_options.hpp"
#include "command/run_record.hpp"
#include "command/scene_report.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "loading/load_scene.hpp"
#include "photile/limits.hpp"
#include "publish/published_room.hpp"
#include "render/quality.hpp"
#include "render/refinement.hpp"
#include "render/render_session.hpp"
#include "view/moods.hpp"
#include "view/scene_loader.hpp"

namespace photile::app {
namespace {

/// Settings that a page has no use for.
const std::initializer_list<std::string_view> without{"samples_per_pixel", "direct_rays",
                                                      "light_maps"};

struct PublishOptions {
  RenderOptions render;
  std::vector<std::string> outputs;  ///< .html, and .gltf or .glb
  std::string title;                 ///< "" = by the scene's file
  bake::BakeParameters baking;
};

bool is_page(const std::filesystem::path& file) { return file.extension() == ".html"; }

/// The lights as the page opens with them, then those of the scene's moods.
std::vector<publish::Preset> presets_of(const RenderOptions& options, const LightMix& mix) {
  std::vector<publish::Preset> presets{{"As published", mix, {}}};
  const std::filesystem::path given = options.mood.file;
  const view::Moods moods(given.empty() ? view::Moods::file_of(options.scene) : given);
  if (std::filesystem::exists(moods.file())) note_input(moods.file());
  for (const std::string& name : moods.names()) {
    presets.push_back(publish::preset_of(name, mix, moods.changes(name, mix)));
  }
  return presets;
}

std::vector<std::filesystem::path> files_of(const std::vector<std::string>& outputs,
                                            const Scene& scene, const LightMix& mix) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path file : outputs) {
    if (is_page(file)) publish::check_materials(scene);
    const auto own = is_page(file) ? std::vector{file} : bake::files_of(file, scene, mix);
    files.insert(files.end(), own.begin(), own.end());
  }
  return files;
}

/// What moves the sky on the page: the scene that is to be loaded gets a sky of patches, unless the
/// options ask for the sky of one hour or of another kind.
SkySituation sky_of_page(SceneLoadOptions& load) {
  const SkySituation given = load.situation;
  const bool placed = given.site || !given.weather.empty();
  const bool moves = load.sky ? load.sky->kind == SkyKind::patches : !given.time;
  return placed && moves && !load.sun ? view::take_moving_sky(load) : given;
}

/// The light maps of a room.
class LitRoom {
 public:
  LitRoom(const std::shared_ptr<const PreparedScene>& scene, std::span<Device> devices,
          const RenderParameters& parameters, const bake::BakeParameters& baking,
          Progress& progress)
      : scene_(scene->rays.scene()),
        baking_(baking),
        session_(scene, devices, parameters, progress) {}

  /// See RenderSession::add_parts.
  void add_parts(int parts, Progress& progress) {
    baked_.reset();
    session_.add_parts(parts, progress);
    bake(progress);
  }

  const bake::BakedLight& baked() const { return *baked_; }
  /// How `photile render` shows what a camera sees, by the light maps as they are.
  ToneMapping shown(const Camera& camera, const PictureOptions& options, const LightMix& mix,
                    Progress& progress) {
    constexpr int samples = 4;  // of 200,000 pixels: more would not change their mean
    Film film;
    set_film_size(film, "", camera);
    film.samples_per_pixel = samples;
    QuietProgress quiet(progress);
    const RenderResult first = session_.render(camera_hits(camera), film, quiet);
    const auto picture = mixed_picture(first.layers, mix);
    image::keep_white(picture->header(),
                      white_of_scene(options, first.layers, scene_, mix.lumen_per_watt));
    const Image root = picture->root();
    const Image* const only = &root;
    return with_one_exposure(shown_as(options, *picture), std::span(&only, 1));
  }

  /// As GatheredNodes::errors; none where photons fill nodes.
  std::optional<LightTable> errors() {
    const cache::GatheredNodes* nodes = session_.light().gathered();
    return nodes ? std::optional(nodes->errors(session_.light().cache()->maps().values()))
                 : std::nullopt;
  }

 private:
  void bake(Progress& progress) {
    cache::SurfaceCache& cache = *session_.light().cache();
    bake::BakeParameters baking = baking_;
    if (!baking.exact) {  // finer in a small room, as nodes are
      baking.texel = std::min(defaults::published_texel, cache.maps().charts().spacing() / 2);
    }
    baked_.emplace(scene_, cache.maps(), baking, progress);
  }

  const Scene& scene_;
  const bake::BakeParameters baking_;
  RenderSession session_;
  std::optional<bake::BakedLight> baked_;
};

void run_publish(PublishOptions& options) {
  handle_signals();
  const TimeTaken loading = time_of_loading();
  const Stopwatch since_loaded;
  const auto elapsed = [&] { return loading.seconds + since_loaded.seconds(); };
  RenderOptions& render = options.render;
  render.parameters.light_maps = LightMapMode::on;
  check(render.parameters);
  check_goal(render.goal, render.parameters);
  note_inputs_of(render);
  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  const SkySituation situation = sky_of_page(render.load);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  const Camera opening = opening_camera(scene, render);
  check_outputs(files_of(options.outputs, scene, mix));
  const std::vector<publish::Preset> presets = presets_of(render, mix);
  const publish::SkyHours hours = publish::sky_hours(mix, situation);
  std::vector<Device> devices = devices_for(render, progress);
  tell_scene(scene, mix, render.load, progress);

  const auto prepared_scene = std::make_shared<const PreparedScene>(scene);
  options.baking.open = bake::open_sides(prepared_scene->rays);
  for (const MixedLight& light : mix.lights)
    options.baking.powers.push_back(mix.power_in_picture(light));
  options.baking.most_texels =
      limits::max_published_texels / std::max<std::size_t>(1, mix.lights.size());

  std::vector<bool> reaches;
  const std::vector<std::uint8_t> seen = bake::seen_sides(prepared_scene->rays);
  const auto write = [&](LitRoom& lit) {
    reaches = lit.baked().reaches(seen, mix.lights.size());
    progress.begin("write files", 0, "");
    const std::optional<LightTable> errors = lit.errors();
    const bool has_page = std::any_of(options.outputs.begin(), options.outputs.end(), is_page);
    const ToneMapping display =
        has_page ? lit.shown(opening, render.pictures, mix, progress) : ToneMapping();
    for (const std::filesystem::path file : options.outputs) {
      if (!is_page(file)) {
        bake::write_baked(file, scene, lit.baked(), mix);
        continue;
      }
      publish::write_page(
          file,
          {.scene = scene,
           .opening = opening,
           .atlas = lit.baked(),
           .light = &lit.baked(),
           .mix = mix,
           .node_errors = errors ? &*errors : nullptr,
           .relative_error = 1 / std::sqrt(static_cast<double>(render.parameters.neighbours)),
           .presets = presets,
           .hours = hours,
           .display = display,
           .title = options.title.empty() ? std::filesystem::path(render.scene).stem().string()
                                          : options.title,
           .version = version_number()});
    }
    progress.end();
    for (const std::string& file : options.outputs) {
      progress.note(fmt::format("{}: {:.3g} MB, {} lights, {} x {} texels, {:.3g} cm apart", file,
                                static_cast<double>(std::filesystem::file_size(file)) / 1e6,
                                mix.lights.size(), lit.baked().width(), lit.baked().height(),
                                100 * lit.baked().texel()));
    }
  };
  RefinementGoal goal = render.goal;
  RenderParameters part = first_part(goal, render.parameters);
  if (!goal.is_given() && in_parts(part)) {
    goal.parts = part.passes;
    part = part_of(part);
  }
  LitRoom lit(prepared_scene, devices, part, options.baking, progress);
  const auto add = [&](int parts, Progress& deadline) {
    lit.add_parts(parts, deadline);
    return goal.is_given() ? lit.baked().standard_error(options.baking.powers, *lit.errors()) : 0.0;
  };
  const auto finished = [&](int parts, double error) {
    if (parts < goal.parts) return;
    write(lit);
    if (!goal.is_given()) return;
    progress.note(fmt::format("standard error {:.2g}%, {}; {}", 100 * error,
                              format_seconds(elapsed()),
                              options_text(of_parts(part, parts), without)));
  };
  refine(goal, {add, finished, elapsed, most_work(part)}, progress);
  warn_of_dark_lights(scene, mix, reaches, "surface that a camera sees", progress);
}

}  // namespace

void add_publish_command(CLI::App& photile) {
  auto options = std::make_shared<PublishOptions>();
  CLI::App* command = photile.add_subcommand(
      "publish", "Write a web page to walk through the room and set its lights");
  const OptionGroup output(*command, "Output");
  output
      .repeat("-o,--output", options->outputs, "FILE.html",
              "page to write, one file; .glb or .gltf for other programs; repeatable",
              file_ending_in({".html", ".glb", ".gltf"}))
      ->required();
  output.add("--title", options->title, "TEXT",
             "title of the page; default: the name of the scene file");
  add_exposure_option(output, options->render.pictures.tone_mapping.exposure);
  add_white_option(output, options->render.pictures.white);
  CLI::Option* texel = output.add(
      "--texel", options->baking.texel, "M",
      fmt::format("distance between texels of the light maps, m; default: {}, or what fits",
                  defaults::published_texel),
      positive_number());
  add_view_options(OptionGroup(*command, "Picture"), options->render);
  set_quality(options->render.quality_options(), Quality::good);
  add_quality_preset(*command, options->render.quality_options());
  OptionGroup(*command, "Quality")
      .add("--for", options->render.goal.seconds, "TIME",
           "add rays and photons for this time, starting with a quarter of the rays; the page then "
           "depends on the machine",
           duration());
  add_setting_options(*command, options->render, without,
                      {display_view_setting(options->render.pictures.tone_mapping)});
  command->callback([options, texel] {
    options->baking.exact = texel->count() > 0;
    run_publish(*options);
  });
}

}  // namespace photile::app
