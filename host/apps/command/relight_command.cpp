#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/scene_options.hpp"
#include "command/scene_report.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "view/moods.hpp"
#include "walk/frames.hpp"

namespace photile::app {
namespace {

struct RelightOptions {
  std::string input;
  std::vector<LightChange> lights;
  std::vector<std::string> moods;
  std::string moods_file;  ///< "" = beside the picture
  std::string sheet;       ///< .png, "" = none
  SkySituation situation;
  std::optional<Sky> sky;

  bool by_time() const {
    return sky || situation.time || situation.site || !situation.weather.empty();
  }
  PictureOptions pictures;
};

void print_lights(const LightMix& mix) {
  const std::vector<std::uint32_t> patch_of = loading::patch_of_layers(mix);
  for (std::size_t i = 0; i < mix.lights.size(); ++i) {
    const MixedLight& light = mix.lights[i];
    if (patch_of[i] != none) continue;
    std::cout << fmt::format("{}: {}: {}\n", light.members.empty() ? "light" : "group", light.name,
                             format_power_in_lumens(light.power, light.unit, mix.lumen_per_watt));
  }
  for (const std::string& line : sky_summary(mix)) std::cout << line << '\n';
}

/// The picture in each mood, all with one exposure and the white of the lamps as rendered. Errors:
/// those of mood_of_picture.
void write_sheet(const RelightOptions& options, const std::vector<LightChange>& changes) {
  const std::filesystem::path file = moods_of_picture(options.moods_file, options.input);
  const std::vector<std::string> names =
      options.moods.empty() ? view::Moods(file).names() : options.moods;
  if (names.empty()) throw UsageError(file.string() + ": no moods; save some on the live page");
  std::vector<Image> pictures;
  for (const std::string& mood : names) {
    const auto asked = mood_of_picture({mood, file.string()}, options.input);
    const auto picture = relit_picture(options.input, joined(asked, changes));
    pictures.push_back(picture->root());
    throw_if_stop_requested();
  }
  std::vector<const Image*> all;
  for (const Image& picture : pictures) all.push_back(&picture);
  const ToneMapping shared =
      with_one_exposure(shown_as(options.pictures, *relit_picture(options.input, {})), all);
  walk::ContactSheet sheet(static_cast<int>(names.size()), pictures[0].width, pictures[0].height);
  for (std::size_t i = 0; i < names.size(); ++i) {
    sheet.add(static_cast<int>(i), tone_map(pictures[i], shared), names[i]);
  }
  write_png(options.sheet, sheet.image());
}

void run_relight(const RelightOptions& options) {
  handle_signals();
  std::vector<LightChange> changes;
  if (options.by_time())
    changes = loading::sky_changes(read_light_mix(options.input), options.situation, options.sky);
  changes = joined(std::move(changes), options.lights);
  const PictureOutputs outputs(options.pictures);
  const bool to_sheet = !options.sheet.empty();
  if (outputs.empty() && !to_sheet && (!changes.empty() || !options.moods.empty())) {
    throw UsageError("no output; give -o FILE.exr or -o FILE.png");
  }
  if (options.moods.size() > 1 && (!to_sheet || !outputs.empty())) {
    throw UsageError(fmt::format(
        "--mood: a picture has one mood, and {} are given; give one, or --sheet FILE.png for a "
        "contact sheet of all, without other outputs",
        options.moods.size()));
  }
  note_input(options.input);
  std::vector<std::filesystem::path> files = outputs.files();
  if (to_sheet) files.emplace_back(options.sheet);
  check_outputs(files);

  if (to_sheet) write_sheet(options, changes);
  if (files.empty()) {
    print_lights(read_light_mix(options.input));
  }
  if (outputs.empty()) return;
  const MoodOptions mood{options.moods.empty() ? "" : options.moods[0], options.moods_file};
  const std::unique_ptr<LayeredPicture> picture =
      relit_picture(options.input, joined(mood_of_picture(mood, options.input), changes));
  throw_if_stop_requested();
  TerminalProgress notes(false);
  if (options.by_time()) {
    SceneLoadOptions load;
    load.situation = options.situation;
    load.sky = options.sky;
    for (const std::string& line : sky_lines(load)) notes.note(line);
  }
  outputs.write(*picture, notes, options.input);
}

}  // namespace

void add_relight_command(CLI::App& photile) {
  auto options = std::make_shared<RelightOptions>();
  CLI::App* command = photile.add_subcommand(
      "relight", "Change the lights of a rendered EXR; without --light and -o, list them");
  command->add_option("PICTURE", options->input, "EXR with a layer per light")
      ->required()
      ->type_name("");
  const OptionGroup lamps(*command), sky(*command, "Sky of patches");
  add_light_change_option(lamps, options->lights);
  lamps.repeat(
      "--mood", options->moods, "NAME",
      "mood saved on the live page under this name; --light changes it further; repeatable "
      "with --sheet");
  add_moods_file_option(lamps, options->moods_file);
  lamps.add("--sheet", options->sheet, "FILE.png",
            "contact sheet of the given moods, or of all in the file, with one exposure",
            file_ending_in({".png"}));
  add_situation_options(sky, options->situation);
  sky.parse("--sky", options->sky, "perez=DIRECT,DIFFUSE",
            "direct W/m2 facing the sun and diffuse W/m2 on a horizontal surface; default: those "
            "of --weather");
  add_picture_options(*command, options->pictures);
  add_false_colour_options(*command, options->pictures.false_colour);
  add_set_option(*command, {display_settings(options->pictures)});
  command->callback([options] { run_relight(*options); });
}

}  // namespace photile::app
