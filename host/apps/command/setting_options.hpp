// Settings of the command: those with their own option, and those that --set sets by name. Most are
// rows of the table of settings (render/setting.hpp); a few say how scenes are read and how devices
// are used.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "photile/device.hpp"
#include "photile/image.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "render/setting.hpp"

namespace CLI {
class App;
}

namespace photile::app {

struct PictureOptions;

/// What --set can set.
using Settings = std::vector<Setting>;

/// The settings of the table, except those with their own option and those named in `without`.
Settings rendering_settings(RenderParameters& parameters,
                            std::initializer_list<std::string_view> without = {});
Settings scene_settings(SceneLoadOptions& options);
Settings device_settings(DeviceOptions& options);
Settings display_settings(PictureOptions& options);
Setting display_view_setting(ToneMapping& parameters);
Setting white_balance_setting(PictureOptions& options);
Settings glare_settings(double& limit);

/// Sets what "NAME=VALUE" names. Errors: UsageError of one line, with a remedy, for an unknown name
/// and for a value out of its range.
void assign_named(const Settings& settings, const std::string& assignment);

/// Adds --set NAME=VALUE, whose errors are those of assign_named.
void add_set_option(CLI::App& command, std::initializer_list<Settings> settings);

/// Names that were given to --set.
std::vector<std::string> names_set(const CLI::App& command);

/// Whether only photon maps use the setting.
bool is_of_photon_maps(std::string_view name);

/// What to type in place of an option that is a setting: "--radius is a setting: --set radius=0.1".
/// "" where there is no such setting.
///   argument   "--radius" or "--radius=0.1"
///   next       the argument after it, or ""
std::string remedy_for_option(const std::string& argument, const std::string& next);

/// Adds the options of settings that have one (but --size), without those named. Defaults are what
/// `parameters` hold.
void add_settings(CLI::App& command, RenderParameters& parameters,
                  std::initializer_list<std::string_view> without = {});

/// Adds the option of one.
void add_setting(CLI::App& command, RenderParameters& parameters, std::string_view name);

/// "--neighbours"; the name where a setting has no option.
std::string option_of(const Setting& setting);

/// Values by name.
///   all   or those that paths have, too
nlohmann::json settings_json(const RenderParameters& parameters, bool all);

/// What to type for these parameters: "--photons 1000000 -k 50 --samples 4", and all settings whose
/// values are not the defaults.
///   without   names of settings that the command does without
std::string options_text(const RenderParameters& parameters,
                         std::initializer_list<std::string_view> without = {});

/// What `photile settings` prints: all that --set can set.
std::string settings_text();

/// The list as docs/reference/settings.md holds it, in Markdown, and what qualities set.
std::string settings_markdown();

}  // namespace photile::app
