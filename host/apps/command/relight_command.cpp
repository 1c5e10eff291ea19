#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "command/command_line.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/scene_options.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"

namespace photile::app {
namespace {

struct RelightOptions {
  std::string input;
  std::vector<std::string> lights;
  MoodOptions mood;
  SkySituation situation;
  std::optional<Sky> sky;

  bool by_time() const {
    return sky || situation.time || situation.site || !situation.weather.empty();
  }
  PictureOptions pictures;
};

void print_lights(const LightMix& mix) {
  for (const MixedLight& light : mix.lights) {
    std::cout << fmt::format("{}: {}: {}\n", light.members.empty() ? "light" : "group", light.name,
                             format_power_in_both(light.power, light.unit, mix.lumen_per_watt));
  }
}

void run_relight(const RelightOptions& options) {
  handle_signals();
  std::vector<LightChange> changes;
  if (options.by_time())
    changes = loading::sky_changes(read_light_mix(options.input), options.situation, options.sky);
  for (const auto& text : options.lights) changes.push_back(LightChange::parse(text));
  const PictureOutputs outputs(options.pictures);
  if (outputs.empty() && (!changes.empty() || options.mood.asked())) {
    throw UsageError("no output; give -o FILE.exr or -o FILE.png");
  }
  note_input(options.input);
  check_outputs(outputs.files());

  if (outputs.empty()) {
    print_lights(read_light_mix(options.input));
    return;
  }
  const std::unique_ptr<LayeredPicture> picture =
      relit_picture(options.input, joined(mood_of_picture(options.mood, options.input), changes));
  throw_if_stop_requested();
  TerminalProgress notes(false);
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
  command
      ->add_option("--light", options->lights,
                   "power in the light's unit, a factor (x2), a colour or off; repeatable")
      ->type_name("NAME=POWER|xFACTOR|N%|#RRGGBB|KELVINK|off")
      ->allow_extra_args(false);
  add_mood_options(*command, options->mood, "Options");
  add_situation_options(*command, options->situation, "Sky of patches");
  command
      ->add_option_function<std::string>(
          "--sky", [options](const std::string& text) { options->sky = Sky::parse(text); },
          "W/m2 facing the sun and on a horizontal surface; default: those of --weather")
      ->type_name("perez=DIRECT,DIFFUSE")
      ->group("Sky of patches");
  add_picture_options(*command, options->pictures);
  add_false_colour_options(*command, options->pictures.false_colour);
  add_set_option(*command, {display_settings(options->pictures.tone_mapping)});
  command->callback([options] { run_relight(*options); });
}

}  // namespace photile::app
