#include "command/tone_mapping_options.hpp"

#include <CLI/CLI.hpp>

#include "command/validators.hpp"
#include "photile/limits.hpp"

namespace photile::app {

void add_view_option(CLI::App& command, DisplayView& view, const std::string& group) {
  Words names;
  for (const DisplayView one : all_display_views) names.words.push_back(name_of(one));
  const auto set = [&view](const std::string& name) {
    for (const DisplayView one : all_display_views) {
      if (name_of(one) == name) view = one;
    }
  };
  command
      .add_option_function<std::string>("--view", set,
                                        "display transform: Khronos PBR Neutral, in which "
                                        "highlights roll off, or the sRGB curve alone")
      ->type_name("neutral|standard")
      ->transform(within(names))
      ->default_str(std::string(name_of(view)))
      ->group(group);
}

void add_tone_mapping_options(CLI::App& command, ToneMapping& parameters,
                              const std::string& group) {
  command.add_option("--exposure", parameters.exposure, "stops, for PNGs and the window alone")
      ->type_name("STOPS")
      ->transform(number_between(-limits::max_exposure_stops, limits::max_exposure_stops))
      ->capture_default_str()
      ->group(group);
  add_view_option(command, parameters.view, group);
}

}  // namespace photile::app
