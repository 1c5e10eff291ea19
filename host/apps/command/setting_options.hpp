// The table of settings (render/setting.hpp) as options, as text for records, and as documentation.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "render/setting.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds the options of all settings but those named in `without`. Defaults are what `parameters`
/// hold.
void add_settings(CLI::App& command, RenderParameters& parameters,
                  std::initializer_list<std::string_view> without = {});

/// Adds the option of one.
void add_setting(CLI::App& command, RenderParameters& parameters, std::string_view name);

/// "--neighbours"; the name where a setting has no option.
std::string option_of(const Setting& setting);

/// Values by name.
///   all   or those that paths have, too
nlohmann::json settings_json(const RenderParameters& parameters, bool all);

/// What to type for these parameters: "--photons 1000000 -k 50 --samples 4", and all options whose
/// values are not the defaults.
std::string options_text(const RenderParameters& parameters);

/// The table as docs/command-line.md holds it, Markdown.
std::string settings_table();

}  // namespace photile::app
