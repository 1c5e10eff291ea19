#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "command/command_line.hpp"
#include "command/setting_options.hpp"

namespace photile::app {

void add_settings_command(CLI::App& photile) {
  CLI::App* command =
      photile.add_subcommand("settings", "List what --set sets, with defaults and ranges");
  auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown, "as docs/settings.md holds it");
  command->callback(
      [markdown] { std::cout << (*markdown ? settings_markdown() : settings_text()); });
}

}  // namespace photile::app
