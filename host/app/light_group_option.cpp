#include "app/light_group_option.hpp"

#include <CLI/CLI.hpp>

namespace photile::app {

CLI::Option* add_light_group_option(CLI::App& command, SceneLoadOptions& options) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--light-group",
          [&options](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              options.light_groups.push_back(LightGrouping::parse(text));
            }
          },
          "lights whose names match become one layer; repeatable")
      ->type_name("GLOB=NAME")
      ->allow_extra_args(false);
}

}  // namespace photile::app
