#include "tools/command/quality_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <string>

#include "photile/errors.hpp"
#include "render/refinement.hpp"
#include "render/render_plan.hpp"
#include "tools/command/number_format.hpp"
#include "tools/command/validators.hpp"

namespace photile::app {
namespace {

std::string percent(double share) { return fmt::format("{:.2g}%", 100 * share); }

std::string milliseconds(double seconds) { return fmt::format("{:.0f} ms", 1e3 * seconds); }

/// What a picture by the chosen settings is expected to err by, cause by cause.
std::string causes(const ErrorModel& model, const QualityChoice& choice) {
  const auto photons = static_cast<double>(choice.photons);
  const double noise = model.noise / std::max(choice.neighbours - 2.0, 0.5);
  const double sampling = model.sampling / choice.samples_per_pixel;
  const double bias = model.bias * std::pow(choice.neighbours / photons, model.exponent);
  return fmt::format("noise of the photons {}, of the samples {}, blur {}",
                     percent(std::sqrt(noise)), percent(std::sqrt(sampling)),
                     percent(std::sqrt(bias)));
}

void tell(const QualityTarget& target, const QualityModels& models, const QualityChoice& choice,
          Progress& progress) {
  progress.note(fmt::format("chosen: --photons {} -k {} --samples {}, from quick pictures of {}",
                            choice.photons, choice.neighbours, choice.samples_per_pixel,
                            format_seconds(models.seconds)));
  progress.note(fmt::format("expected: error {} ({}); first picture {}, each further frame {}",
                            percent(choice.expected_error), causes(models.error, choice),
                            format_seconds(choice.expected_first_picture_seconds),
                            milliseconds(choice.expected_frame_seconds)));
  if (choice.reached) return;
  std::string wanted;
  if (target.relative_error > 0) wanted = "an error of " + percent(target.relative_error);
  if (target.frame_seconds > 0) {
    wanted += (wanted.empty() ? "" : " and ") +
              fmt::format("frames of {}", milliseconds(target.frame_seconds));
  }
  progress.note(fmt::format("warning: {} is not within reach here; this is the nearest", wanted));
}

}  // namespace

std::span<const QualityWish> quality_wishes() {
  static constexpr std::array<QualityWish, 3> wishes{{
      {"target_error", "target-error", "PERCENT",
       "make pictures until one states this root mean square relative error; where nodes of light "
       "maps do not gather, choose photons, k and samples for it by a model",
       &QualityTarget::relative_error},
      {"for", "for", "TIME",
       "make better and better pictures for so long, where nodes of light maps gather; depends on "
       "the machine",
       &QualityTarget::run_seconds},
      {"time_budget", "time-budget", "TIME",
       "choose k and samples for pictures of this time, once the photon maps are there, by a "
       "model; otherwise as --quality draft",
       &QualityTarget::frame_seconds},
  }};
  return wishes;
}

void set_quality(const QualityOptions& options, Quality quality) {
  options.quality = quality;
  photile::set_quality(options.parameters, quality);
}

void add_quality_preset(CLI::App& command, const QualityOptions& options) {
  Words names;
  for (const Quality quality : all_qualities) names.words.push_back(name_of(quality));
  command
      .add_option_function<std::string>(
          "--quality",
          [options](const std::string& word) {
            for (const Quality quality : all_qualities) {
              if (name_of(quality) == word) set_quality(options, quality);
            }
          },
          std::string(quality_help))
      ->type_name(fmt::format("{}", fmt::join(names.words, "|")))
      ->transform(within(names))
      ->default_str(std::string(name_of(options.quality)))
      ->group("Picture");
}

void add_quality_wishes(CLI::App& command, const QualityOptions& options) {
  for (const QualityWish& wish : quality_wishes()) {
    command
        .add_option_function<double>(
            fmt::format("--{}", wish.option),
            [options, &wish](double value) {
              options.target.*wish.value = value;
              if (options.target.frame_seconds > 0) set_quality(options, Quality::draft);
            },
            std::string(wish.help))
        ->type_name(std::string(wish.type))
        ->transform(wish.type == "TIME" ? duration() : share_up_to(1))
        ->group("Quality");
  }
}

void exclude_chosen(CLI::App& command) {
  CLI::Option* error = command.get_option("--target-error");
  CLI::Option* time = command.get_option("--time-budget");
  for (const char* chosen : {"--neighbours", "--samples", "--radius"}) {
    error->excludes(chosen);
    time->excludes(chosen);
  }
  time->excludes("--quality");
  time->excludes("--for");
  error->excludes("--photons");
}

bool refines(const QualityTarget& target, const RenderParameters& parameters) {
  const bool gathers = nodes_gather(parameters);
  if (target.run_seconds > 0 && !gathers) {
    throw UsageError("--for: pictures are made better where nodes gather, as with --quality good");
  }
  return gathers && (target.relative_error > 0 || target.run_seconds > 0);
}

RenderResult render_refined(
    const QualityTarget& target, const RenderParameters& parameters,
    const std::function<RenderResult(const RenderParameters&, Progress&)>& make,
    const std::function<void(const RenderResult&)>& finished,
    const std::function<double()>& elapsed, Progress& progress) {
  int pictures = 0;
  const auto tell = [&](const RenderResult& picture) {
    finished(picture);
    progress.note(fmt::format("picture {}: {} photons, {} rays a node, standard error {}, {}",
                              ++pictures, picture.used.photons.emitted_photons,
                              picture.used.light_map_rays, percent(standard_error_of(picture)),
                              format_seconds(elapsed())));
  };
  return refine({target.relative_error, target.run_seconds}, parameters, {make, tell, elapsed},
                progress);
}

bool is_wanted(const QualityTarget& target) {
  return target.relative_error > 0 || target.frame_seconds > 0;
}

StageStatistics choose_quality(const QualityTarget& target, const Scene& scene,
                               const Camera& camera, Device& device, const LightMix& mix,
                               RenderParameters& parameters, Progress& progress) {
  const QualityModels models = measure_models(scene, camera, device, mix, parameters, progress);
  const QualityChoice choice =
      choose_settings(target, models.error, models.time, parameters.photons.emitted_photons);
  tell(target, models, choice, progress);
  parameters.photons.emitted_photons = choice.photons;
  parameters.neighbours = choice.neighbours;
  parameters.film.samples_per_pixel = choice.samples_per_pixel;
  return {.stage = "choose settings",
          .seconds = models.seconds,
          .figures = {{"expected relative error", choice.expected_error},
                      {"expected frame seconds", choice.expected_frame_seconds},
                      {"expected first picture seconds", choice.expected_first_picture_seconds}}};
}

}  // namespace photile::app
