#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command/command_line.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/quality_options.hpp"
#include "command/render_options.hpp"
#include "command/run_record.hpp"
#include "command/saved_maps_option.hpp"
#include "command/scene_report.hpp"
#include "command/setting_options.hpp"
#include "command/summary.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "device/context.hpp"
#include "image/display.hpp"
#include "image/glare.hpp"
#include "image/light_layers.hpp"
#include "loading/load_scene.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "render/hit_source.hpp"
#include "render/quality.hpp"
#include "render/refinement.hpp"
#include "render/render_costs.hpp"
#include "render/render_plan.hpp"
#include "render/render_session.hpp"

namespace photile::app {
namespace {

std::string percent(double fraction) { return fmt::format("{:.2g}%", 100 * fraction); }

PictureOutputs check_outputs_of(const RenderOptions& options) {
  PictureOutputs outputs(options.pictures);
  if (outputs.empty() && options.glare.empty()) {
    throw UsageError("no output; give -o FILE.exr or -o FILE.png");
  }
  auto files = outputs.files();
  if (!options.statistics.empty()) files.emplace_back(options.statistics);
  if (!options.glare.empty()) files.emplace_back(options.glare);
  if (!options.errors.empty()) files.emplace_back(options.errors);
  if (!options.save_maps.empty()) files.emplace_back(options.save_maps);
  note_inputs_of(options);
  check_outputs(files);
  return outputs;
}

/// Runs `work` as a separate stage and returns its cost.
template <class Work>
StageStatistics timed_stage(const char* name, Progress& progress, const Work& work) {
  progress.throw_if_cancelled();
  progress.begin(name, 0, "");
  const Stopwatch stopwatch;
  work();
  progress.end();
  return stage(name, {stopwatch.taken()});
}

/// Prints and records the cost of the kernels of a device.
void tell_kernels(Device& device, bool profile, RunRecord& record, Progress& progress) {
  KernelRecord kernels{device.info().id,
                       device.programs_built(),
                       device.programs_from_cache(),
                       device.compile_seconds(),
                       {}};
  if (profile) kernels.times = device::context_of(device).kernel_times();
  progress.note(fmt::format("kernels of {}: {} compiled, {} from the cache, {}", device.info().id,
                            device.programs_built(), device.programs_from_cache(),
                            format_seconds(device.compile_seconds())));
  if (profile) {
    for (const auto& line : kernel_table(kernels.times)) progress.note(line);
  }
  record.kernels.push_back(std::move(kernels));
}

/// What is rendered: the picture and, where --glare asks for it, what came by reflection.
struct Views {
  const HitSource& picture;
  LightLayers* reflections;  ///< is filled; may be null
};

/// Records what was found during a rendering.
void note_result(const RenderResult& result, std::span<const Device> devices, RunRecord& record) {
  record.used = result.used;
  record.devices.clear();
  for (const Device& device : devices) record.devices.push_back(device.info());
  record.device_fractions = result.device_fractions;
  record.stored_photons = result.stored_photons;
  record.stages.insert(record.stages.end(), result.statistics.begin(), result.statistics.end());
}

/// Whether photon maps outlive the picture that they are made for.
bool keeps_maps(const RenderOptions& options) {
  return !options.save_maps.empty() || !options.load_maps.empty() || !options.glare.empty();
}

/// Pictures in more and more parts until one is good enough; `write` writes the last of `record`.
///   elapsed   since the process began, seconds
void render_until_good(const Scene& scene, std::span<Device> devices, const RenderOptions& options,
                       const HitSource& hits, RunRecord& record,
                       const std::function<void(const LightLayers&)>& write,
                       const std::function<double()>& elapsed, Progress& progress) {
  const RunStatistics before = record.stages;
  const RenderParameters part = first_part(options.goal, options.parameters);
  RenderSession session(std::make_shared<const PreparedScene>(scene), devices, part, progress);
  RenderResult latest;
  const auto add = [&](int parts, Progress& deadline) {
    session.add_parts(parts, deadline);
    latest = session.render(hits, session.film(), deadline);
    return latest.standard_error;
  };
  int pictures = 0;
  const auto finished = [&](int parts, double error) {
    record.stages = before;
    note_result(latest, devices, record);
    write(latest.layers);
    progress.note(fmt::format("picture {}: standard error {}, {}; {}", ++pictures, percent(error),
                              format_seconds(elapsed()), options_text(of_parts(part, parts))));
  };
  const double error = refine(options.goal, {add, finished, elapsed, most_work(part)}, progress);
  if (options.goal.error > 0 && error > options.goal.error) {
    progress.warn(fmt::format("a standard error of {} was not reached; it is {}",
                              percent(options.goal.error), percent(error)));
  }
}

/// The layers by photon maps. Fills in what `record` states of them.
LightLayers render_by_photons(const Scene& scene, const Camera& camera, std::span<Device> devices,
                              const RenderOptions& options, const Views& views, RunRecord& record,
                              Progress& progress) {
  RenderResult result = keeps_maps(options)
                            ? render_with_kept_maps(scene, camera, views.picture, devices, options,
                                                    views.reflections, progress)
                            : render_hits(scene, views.picture, options.parameters.film, devices,
                                          options.parameters, progress);
  note_result(result, devices, record);
  return std::move(result.layers);
}

/// The layers by path tracing.
LightLayers render_by_paths(const Scene& scene, const Camera& camera, const Views& views,
                            RunRecord& record, Progress& progress) {
  if (has_hidden_caustics(scene)) {
    progress.warn(
        "path tracing does not find light of point, spot and directional lights that mirrors and "
        "glass cast; photon maps do");
  }
  PathTracerResult result =
      trace_paths_of_hits(scene, views.picture, eye_rays(record.used), progress);
  if (views.reflections) {
    PathTracerResult reflected =
        trace_paths_of_hits(scene, reflected_hits(camera), eye_rays(record.used), progress);
    *views.reflections = std::move(reflected.layers);
  }
  record.stages.insert(record.stages.end(), result.statistics.begin(), result.statistics.end());
  return std::move(result.layers);
}

/// The library of --denoise: loaded before the rendering, so that a missing one is reported at
/// once.
class Denoising {
 public:
  ///   film   of the picture
  Denoising(const RenderOptions& options, const Scene& scene, const Camera& camera)
      : denoiser_(options.denoiser, options.threads),
        scene_(scene),
        camera_(camera),
        film_(options.parameters.film),
        seed_(options.parameters.seed) {}

  const std::string& version() const { return denoiser_.version(); }

  ///   errors   standard errors of the layers, or null
  LightLayers denoised(const LightLayers& layers, const LightLayers* errors) {
    if (!guides_) guides_ = denoising_guides(RayScene(scene_), camera_, film_, seed_);
    return denoiser_.denoised(layers, *guides_, errors);
  }

 private:
  Denoiser denoiser_;
  const Scene& scene_;
  const Camera& camera_;
  Film film_;
  std::uint64_t seed_;
  std::optional<DenoisingGuides> guides_;  ///< once they are needed
};

/// Writes the file that --glare names, and prints what is marked. `picture` is that of `layers`,
/// `reflections` are the part of them that came by reflection. Errors: OutputError.
void write_glare(const RenderOptions& options, const LayeredPicture& picture,
                 const LightLayers& layers, const LightLayers& reflections, const LightMix& mix,
                 Progress& progress) {
  const image::Glare glare = image::find_glare(layers, reflections, mix, options.glare_limit);
  const Image displayed = tone_map(picture.root(), shown_as(options.pictures, picture));
  std::vector<std::uint8_t> rgb = image::srgb8_texels(displayed);
  image::draw_marks(glare.marks, rgb);
  OutputFile output(options.glare);
  image::encode_png(output, layers.width, layers.height, rgb);
  output.commit();
  for (const std::string& line : image::glare_lines(glare, mix.unit())) progress.note(line);
}

/// Renders and writes the pictures. Returns a watch that was started when they were written: the
/// memory of the rendering is released before this returns.
///   elapsed   seconds of the process so far
Stopwatch render_to_files(const CLI::App& command, RenderOptions& options, RunRecord& record,
                          const std::function<double()>& elapsed, Progress& progress) {
  check(options.parameters);
  if (options.integrator == Integrator::path) refuse_photon_map_options(command);
  share_rendering(options);
  const bool knows_errors =
      options.integrator == Integrator::photon_map && nodes_gather(options.parameters);
  if (!options.errors.empty() && (!knows_errors || keeps_maps(options))) {
    throw UsageError(
        "--errors: noise is known only where nodes of light maps gather light by rays, as with "
        "--quality good, and without --save-maps, --load-maps and --glare");
  }
  if (!options.denoiser.empty() && knows_errors && keeps_maps(options)) {
    throw UsageError(
        "--denoise needs the noise of nodes, which is not known with --save-maps, --load-maps and "
        "--glare; leave those out");
  }
  check_goal(options.goal, options.parameters);
  if (options.goal.is_given() && keeps_maps(options)) {
    throw UsageError(
        "--target-error and --for trace their own photons; leave out --save-maps, --load-maps and "
        "--glare");
  }
  const PictureOutputs outputs = check_outputs_of(options);

  const ThreadLimit threads(options.threads);
  const Stopwatch device_watch;
  std::vector<Device> devices = devices_for(options, progress);
  record.stages.push_back(stage("open devices", {device_watch.taken()}));

  Scene scene;
  record.stages.push_back(timed_stage("load scene", progress, [&] {
    scene = loading::load_scene(options.scene, options.load, progress);
  }));
  record.mix = mix_of(scene, options);
  tell_scene(scene, record.mix, options.load, progress);
  const Camera camera = projected(camera_of(scene, options), options);
  set_film_size(options.parameters.film, options.size, camera);
  record.scene = scene.source.filename().string();
  record.ground = loading::ground_reflectance(options.load);
  record.surfaces = digest_of_surfaces(scene);
  record.camera = camera.name;
  record.integrator = name_of(options.integrator);
  record.quality = options.quality;
  record.goal = options.goal;
  record.used = options.parameters;

  std::optional<Denoising> denoising;
  if (!options.denoiser.empty()) {
    denoising.emplace(options, scene, camera);
    record.denoiser = denoising->version();
  }
  const bool wants_errors = !options.errors.empty() || (denoising && knows_errors);
  LightLayers errors;
  const HitSource hits = camera_hits(camera, wants_errors ? &errors : nullptr);
  LightLayers reflections;
  const Views views{hits, options.glare.empty() ? nullptr : &reflections};
  std::vector<bool> reaches;
  const auto write = [&](const LightLayers& rendered) {
    if (!leads()) return;
    std::optional<LightLayers> denoised;
    if (denoising) {
      record.stages.push_back(timed_stage("denoise", progress, [&] {
        denoised = denoising->denoised(rendered, wants_errors ? &errors : nullptr);
      }));
    }
    const LightLayers& layers = denoised ? *denoised : rendered;
    const image::White white =
        white_of_scene(options.pictures, rendered, scene, record.mix.lumen_per_watt);
    record.stages.push_back(timed_stage("write pictures", progress, [&] {
      const auto picture_of = [&](const LightLayers& film) {
        std::unique_ptr<LayeredPicture> picture = mixed_picture(film, record.mix);
        set_camera_attributes(picture->header(), in_world(scene, camera), film.width, film.height);
        set_run_attributes(picture->header(), record);
        image::keep_white(picture->header(), white);
        return picture;
      };
      reaches = image::lit_layers(layers);
      const auto picture = picture_of(layers);
      outputs.write(*picture, progress);
      if (!options.errors.empty()) write_exr(options.errors, *picture_of(errors));
      if (views.reflections) {
        write_glare(options, *picture, layers, reflections, record.mix, progress);
      }
    }));
  };
  if (options.goal.is_given()) {
    render_until_good(scene, devices, options, hits, record, write, elapsed, progress);
  } else if (options.integrator == Integrator::path) {
    write(render_by_paths(scene, camera, views, record, progress));
  } else {
    write(render_by_photons(scene, camera, devices, options, views, record, progress));
  }
  if (!reaches.empty()) {
    warn_of_dark_lights(scene, record.mix, reaches, "part of the picture", progress);
  }
  for (Device& device : devices) tell_kernels(device, options.device.profile, record, progress);
  return {};
}

void run_render(const CLI::App& command, RenderOptions& options) {
  handle_signals();
  const TimeTaken loading = time_of_loading();
  const Stopwatch since_loaded;
  RunRecord record;
  record.stages.push_back(stage("load libraries", {loading}));
  TerminalProgress progress(options.quiet || !leads());
  const auto elapsed = [&] { return loading.seconds + since_loaded.seconds(); };
  const Stopwatch since_written = render_to_files(command, options, record, elapsed, progress);
  add_time(record.stages, "release memory", since_written.taken());
  TimeTaken total = since_loaded.taken();
  close(record, total += loading);
  if (!options.statistics.empty() && leads()) {
    write_file(options.statistics, json_text(run_json(record), 2));
  }
  for (const auto& line : summary_table(record)) progress.note(line);
}

}  // namespace

void add_render_command(CLI::App& photile) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = photile.add_subcommand("render", "Render a scene to an EXR and a PNG");
  add_render_options(*command, *options);
  command->callback([command, options] { run_render(*command, *options); });
}

}  // namespace photile::app
