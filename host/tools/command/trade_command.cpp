#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "photile/path_tracer.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/number_format.hpp"
#include "tools/command/output_files.hpp"
#include "tools/command/render_options.hpp"
#include "tools/command/signals.hpp"
#include "tools/command/terminal_progress.hpp"
#include "tools/command/threads.hpp"
#include "tools/command/trade_report.hpp"
#include "tools/command/validators.hpp"
#include "tools/command/version.hpp"
#include "trace/random_stream.hpp"

namespace photile::app {
namespace {

struct TradeOptions {
  RenderOptions render;
  std::string folder;
  std::string reference;  ///< file; "" = traced
  int reference_samples = defaults::reference_samples;
};

/// The files that the command writes.
struct TradeFiles {
  std::filesystem::path csv, json, reference;

  explicit TradeFiles(const std::filesystem::path& folder)
      : csv(folder / "trade.csv"),
        json(folder / "trade.json"),
        reference(folder / "reference.exr") {}
};

struct Reference {
  Image picture;
  double relative_mse = -1;  ///< its own noise; below 0 where it is not known
};

/// A path-traced picture, in two halves whose difference tells its noise.
Reference trace_reference(const Scene& scene, const Camera& camera, const LightMix& mix,
                          const TradeOptions& options, Progress& progress) {
  if (has_unseen_caustics(scene)) {
    progress.note(
        "warning: the path-traced reference lacks what mirrors and glass throw from point, spot "
        "and directional lights; give a complete one with --reference");
  }
  PrimaryHitParameters film = eye_rays(options.render.parameters);
  film.samples_per_pixel = std::max(1, options.reference_samples / 2);
  const std::uint64_t seed = film.seed;
  film.seed = trace::seed_of_repeat(seed, 0);  // paths of its own
  const Image first = mixed_picture(trace_paths(scene, camera, film, progress).layers, mix)->root();
  film.seed = trace::seed_of_repeat(seed, 1);
  Reference reference{
      mixed_picture(trace_paths(scene, camera, film, progress).layers, mix)->root()};
  for (std::size_t plane = 0; plane < first.channels.size(); ++plane) {
    std::vector<float>& values = reference.picture.channels[plane];
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = 0.5f * (values[i] + first.channels[plane][i]);
    }
  }
  // Half the difference of the halves has the variance of their mean.
  reference.relative_mse = picture_error(first, reference.picture).relative_mse;
  return reference;
}

Reference reference_of(const Scene& scene, const Camera& camera, const LightMix& mix,
                       const TradeOptions& options, Progress& progress) {
  if (!options.reference.empty()) return {read_image(options.reference)};
  Reference reference = trace_reference(scene, camera, mix, options, progress);
  progress.note(fmt::format("reference: {} paths a pixel, its own error {:.2g}%",
                            options.reference_samples, 100 * std::sqrt(reference.relative_mse)));
  return reference;
}

void check_size(const std::string& file, const Image& reference, const Film& film) {
  if (reference.width == film.width && reference.height == film.height) return;
  throw UsageError(fmt::format("{}: has {}x{} pixels, the picture {}x{}; give its size with --size",
                               file, reference.width, reference.height, film.width, film.height));
}

void warn_of_noise(const Reference& reference, std::span<const TradePoint> points,
                   Progress& progress) {
  const auto near = std::count_if(points.begin(), points.end(), [&](const TradePoint& point) {
    return point.error.relative_mse < 4 * reference.relative_mse;
  });
  if (near == 0) return;
  progress.note(fmt::format(
      "warning: {} of {} errors are within twice the error of the reference itself, which is in "
      "them; give more --reference-samples",
      near, points.size()));
}

void write_files(const TradeFiles& files, const TradeOptions& options, const Reference& reference,
                 std::span<const TradePoint> points, std::span<const Device> devices) {
  nlohmann::ordered_json record{
      {"photile", version_text()},
      {"scene", std::filesystem::path(options.render.scene).filename().string()},
      {"width", reference.picture.width},
      {"height", reference.picture.height},
      {"devices", nlohmann::json::array()},
      {"renderings", trade_json(points)}};
  for (const Device& device : devices) record["devices"].push_back(device.info().name);
  if (reference.relative_mse >= 0) {
    record["reference_samples"] = options.reference_samples;
    record["reference_relative_mse"] = reference.relative_mse;
    write_exr(files.reference, reference.picture);
  }
  write_file(files.csv, trade_csv(points));
  write_file(files.json,
             record.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void run_trade(TradeOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check_settings(render);
  const TradeFiles files(options.folder);
  make_folder(options.folder);
  note_inputs_of(render);
  note_input(options.reference);
  std::vector<std::filesystem::path> outputs{files.csv, files.json};
  if (options.reference.empty()) outputs.push_back(files.reference);
  check_outputs(outputs);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  std::vector<Device> devices = open_devices(render.device);
  const Scene scene = load_scene(render.scene, render.load);
  const LightMix mix = mix_of(scene, render);
  const Camera& camera = choose_camera(scene, render.camera);
  render.parameters.film.width = defaults::trade_width;
  render.parameters.film.height = defaults::trade_height;
  set_film_size(render.parameters.film, render.size, camera);

  const Reference reference = reference_of(scene, camera, mix, options, progress);
  check_size(options.reference, reference.picture, render.parameters.film);
  const std::vector<TradePoint> points =
      measure_trade({scene, camera, devices, mix, reference.picture}, render.parameters,
                    TradeAxes::around(render.parameters), progress);
  write_files(files, options, reference, points, devices);
  warn_of_noise(reference, points, progress);
  for (const auto& line : trade_table(points)) std::cout << line << '\n';
}

}  // namespace

void add_trade_command(CLI::App& photile) {
  auto options = std::make_shared<TradeOptions>();
  CLI::App* command = photile.add_subcommand(
      "trade", "Measure time and error of many settings on a view, around those given");
  command->add_option("-o,--output", options->folder, "folder for trade.csv and trade.json")
      ->required()
      ->type_name("FOLDER");
  CLI::Option* reference =
      command
          ->add_option("--reference", options->reference,
                       "picture that errors are measured against; default: path traced")
          ->type_name("FILE");
  command
      ->add_option("--reference-samples", options->reference_samples,
                   "paths per pixel of the path-traced reference")
      ->type_name("N")
      ->transform(count_between(2, limits::max_samples_per_pixel))
      ->capture_default_str()
      ->excludes(reference);
  add_picture_settings(*command, options->render);
  command->callback([options] { run_trade(*options); });
}

}  // namespace photile::app
