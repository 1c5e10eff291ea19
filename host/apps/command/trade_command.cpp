#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/render_options.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "trace/random_stream.hpp"
#include "trade/trade.hpp"

namespace photile::app {
namespace {

struct TradeOptions {
  RenderOptions render;
  std::string folder;
  std::string reference;  ///< file; "" = traced
  int reference_samples = defaults::reference_samples;
};

struct Reference {
  Image picture;
  double relative_mse = -1;  ///< its own noise; below 0 where it is not known
};

/// A path-traced picture, in two halves from whose difference its noise is estimated.
Reference trace_reference(const Scene& scene, const Camera& camera, const LightMix& mix,
                          const TradeOptions& options, Progress& progress) {
  if (has_hidden_caustics(scene)) {
    progress.warn(
        "the path-traced reference lacks caustics of point, spot and directional lights; "
        "give a complete one with --reference");
  }
  PrimaryHitParameters film = eye_rays(options.render.parameters);
  film.samples_per_pixel = options.reference_samples / 2;
  const auto half = [&](std::uint32_t repeat) {
    film.seed = trace::seed_of_repeat(options.render.parameters.seed, repeat);  // independent paths
    return mixed_picture(trace_paths(scene, camera, film, progress).layers, mix)->root();
  };
  const Image first = half(0);
  Reference reference{half(1)};
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

/// Errors: UsageError for a file whose picture has another size.
Reference reference_of(const Scene& scene, const Camera& camera, const LightMix& mix,
                       const TradeOptions& options, Progress& progress) {
  if (options.reference.empty()) {
    Reference traced = trace_reference(scene, camera, mix, options, progress);
    progress.note(fmt::format("reference: {} paths per pixel, its own error {:.2g}%",
                              options.reference_samples, 100 * std::sqrt(traced.relative_mse)));
    return traced;
  }
  Reference read{read_image(options.reference)};
  const Film& film = options.render.parameters.film;
  if (read.picture.width != film.width || read.picture.height != film.height) {
    throw UsageError(fmt::format(
        "{}: has {}x{} pixels, the picture {}x{}; give its size with --size", options.reference,
        read.picture.width, read.picture.height, film.width, film.height));
  }
  return read;
}

nlohmann::ordered_json json_of(const trade::TradePoint& point) {
  const PictureError& error = point.error;
  nlohmann::ordered_json row{{"varied", point.settings.varied},
                             {"options", options_text(point.settings.parameters)}};
  row.update(settings_json(point.used, true));
  row.update({{"photons_stored", point.stored_photons}, {"relative_mse", error.relative_mse}});
  row.update({{"relative_error", error.relative_error()}, {"mean_ratio", error.mean_ratio}});
  row.update({{"worst_region", error.worst_region}, {"psnr", error.psnr}});
  row.update({{"first_picture_seconds", point.first_picture_seconds}});
  row.update({{"frame_seconds", point.frame_seconds}});
  row.update({{"host_bytes", point.host_bytes}, {"device_bytes", point.device_bytes}});
  return row;
}

std::string csv_of(const nlohmann::ordered_json& rows) {
  std::vector<std::string> names, lines;
  for (const auto& [name, value] : rows.front().items()) names.push_back(name);
  for (const auto& row : rows) {
    std::vector<std::string> cells;
    for (const auto& value : row) {
      cells.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    lines.push_back(fmt::format("{}", fmt::join(cells, ",")));
  }
  return fmt::format("{}\n{}\n", fmt::join(names, ","), fmt::join(lines, "\n"));
}

std::string row_of(const trade::TradePoint* point) {
  constexpr const char* row = "{:>15}{:>13}{:>12}  {}";
  if (!point) return fmt::format(row, "-", "-", "-", "none of those tried");
  return fmt::format(row, format_seconds(point->first_picture_seconds),
                     fmt::format("{:.0f} ms", 1e3 * point->frame_seconds),
                     format_bytes(point->host_bytes + point->device_bytes),
                     options_text(point->settings.parameters));
}

/// The fastest settings for some errors, and those of the least error.
void print_table(std::span<const trade::TradePoint> points) {
  std::cout << " error  first picture   each frame      memory  fastest settings\n";
  for (const double requested : {0.10, 0.05, 0.02, 0.01}) {
    std::cout << fmt::format("{:>5.0f}%{}\n", 100 * requested,
                             row_of(trade::fastest_within(points, requested)));
  }
  const auto least = std::min_element(points.begin(), points.end(), [](auto& a, auto& b) {
    return a.error.relative_mse < b.error.relative_mse;
  });
  std::cout << fmt::format("{:>5.1f}%{}  (least error)\n", 100 * least->error.relative_error(),
                           row_of(&*least));
}

void warn_of_noise(const Reference& reference, std::span<const trade::TradePoint> points,
                   Progress& progress) {
  const auto near =
      std::count_if(points.begin(), points.end(), [&](const trade::TradePoint& point) {
        return point.error.relative_mse < 4 * reference.relative_mse;
      });
  if (near == 0) return;
  progress.warn(
      fmt::format("{} of {} errors are less than twice the reference's own error, which they "
                  "include; give more --reference-samples",
                  near, points.size()));
}

void run_trade(TradeOptions& options) {
  handle_signals();
  RenderOptions& render = options.render;
  check(render.parameters);
  const std::filesystem::path folder = options.folder;
  const auto csv = folder / "trade.csv", json = folder / "trade.json",
             traced = folder / "reference.exr";
  make_folder(folder);
  note_inputs_of(render);
  note_input(options.reference);
  std::vector<std::filesystem::path> outputs{csv, json};
  if (options.reference.empty()) outputs.push_back(traced);
  check_outputs(outputs);

  const ThreadLimit threads(render.threads);
  TerminalProgress progress(render.quiet);
  std::vector<Device> devices = open_devices(render.device);
  const Scene scene = loading::load_scene(render.scene, render.load, progress);
  const LightMix mix = mix_of(scene, render);
  const Camera camera = camera_of(scene, render);
  Film& film = render.parameters.film;
  film.width = defaults::trade_width;
  film.height = defaults::trade_height;
  set_film_size(film, render.size, camera);

  const Reference reference = reference_of(scene, camera, mix, options, progress);
  const std::vector<trade::TradePoint> points =
      trade::measure_trade({scene, camera, devices, mix, reference.picture},
                           trade::settings_around(render.parameters), progress);
  nlohmann::ordered_json record{{"photile", version_text()},
                                {"scene", scene.source.filename().string()},
                                {"width", film.width},
                                {"height", film.height},
                                {"devices", nlohmann::json::array()},
                                {"renderings", nlohmann::json::array()}};
  for (const Device& device : devices) record["devices"].push_back(device.info().name);
  for (const trade::TradePoint& point : points) record["renderings"].push_back(json_of(point));
  if (options.reference.empty()) {
    record["reference_samples"] = options.reference_samples;
    record["reference_relative_mse"] = reference.relative_mse;
    write_exr(traced, reference.picture);
  }
  write_file(csv, csv_of(record["renderings"]));
  write_file(json, json_text(record));
  warn_of_noise(reference, points, progress);
  print_table(points);
}

}  // namespace

void add_trade_command(CLI::App& photile) {
  auto options = std::make_shared<TradeOptions>();
  options->render.parameters.neighbours = defaults::trade_neighbours;
  CLI::App* command = photile.add_subcommand(
      "trade", "Measure time and error of many settings of a view, around those given");
  const OptionGroup group(*command);
  group.add("-o,--output", options->folder, "FOLDER", "folder for trade.csv and trade.json")
      ->required();
  CLI::Option* reference =
      group.add("--reference", options->reference, "FILE",
                "picture that errors are measured against; default: path traced");
  group
      .add("--reference-samples", options->reference_samples, "N",
           "paths per pixel of the path-traced reference",
           count_between(2, limits::max_samples_per_pixel))
      ->capture_default_str()
      ->excludes(reference);
  add_picture_settings(*command, options->render);
  command->callback([options] { run_trade(*options); });
}

}  // namespace photile::app
