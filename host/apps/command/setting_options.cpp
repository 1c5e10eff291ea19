#include "command/setting_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "common/ascii_text.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"

namespace photile::app {
namespace {

/// "-k", "--neighbours".
std::vector<std::string> option_names(const Setting& setting) {
  std::vector<std::string> names;
  for (const std::string& name : CLI::detail::split(std::string(setting.option), ',')) {
    names.push_back((name.size() == 1 ? "-" : "--") + name);
  }
  return names;
}

/// The placeholder of a value in the help: "N", "X", "naive|triangle|patch|auto".
std::string type_name(const ValueRange& range) {
  if (const auto* words = std::get_if<Words>(&range)) {
    return fmt::format("{}", fmt::join(words->words, "|"));
  }
  if (const auto* text = std::get_if<Text>(&range)) return std::string(text->form);
  return std::holds_alternative<WholeNumbers>(range) ? "N" : "X";
}

bool has_option(const Setting& setting) { return !setting.option.empty(); }

void add(CLI::App& command, RenderParameters& parameters, const Setting& setting) {
  CLI::Option* option =
      OptionGroup(command, std::string(setting.group))
          .call(
              fmt::format("{}", fmt::join(option_names(setting), ",")),
              [&parameters, &setting](const std::string& text) {
                setting.set(parameters, *parse_value(text, setting.range));
              },
              type_name(setting.range), std::string(setting.help), within(setting.range));
  if (setting.is_given(parameters)) option->default_str(text_of(setting.value(parameters)));
}

Setting bound_number(std::string_view name, std::string_view group, ValueRange range, auto& field,
                     std::string_view help, std::string_view unit = {}) {
  using Number = std::remove_reference_t<decltype(field)>;
  return {.name = name,
          .unit = unit,
          .group = group,
          .help = help,
          .otherwise = fmt::format("{}", field),
          .range = std::move(range),
          .assign = [&field](const SettingValue& value) {
            field = static_cast<Number>(std::get<double>(value));
          }};
}

/// A setting whose value is a word or a text.
Setting bound_word(std::string_view name, std::string_view group, ValueRange range,
                   std::string_view help, std::string otherwise,
                   const std::function<void(std::string_view)>& take) {
  return {.name = name,
          .group = group,
          .help = help,
          .otherwise = std::move(otherwise),
          .range = std::move(range),
          .assign = [take](const SettingValue& value) { take(std::get<std::string_view>(value)); }};
}

Setting bound_switch(std::string_view name, std::string_view group, bool& field,
                     std::string_view help) {
  return bound_word(name, group, Words{{"off", "on"}}, help, field ? "on" : "off",
                    [&field](std::string_view word) { field = word == "on"; });
}

/// Defaults of all that --set can set in any command, and where their values go.
class AllSettings {
 public:
  const Settings& list() const { return list_; }

 private:
  RenderParameters parameters_;
  SceneLoadOptions load_;
  DeviceOptions device_;
  PictureOptions pictures_;
  double glare_limit_ = defaults::glare_limit;
  Settings list_ = [this] {
    Settings all;
    for (const Settings& some :
         {rendering_settings(parameters_), scene_settings(load_), device_settings(device_),
          display_settings(pictures_), glare_settings(glare_limit_)}) {
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }();
};

const Setting* named_in(const Settings& settings, std::string_view name) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& one) { return one.name == name; });
  return found == settings.end() ? nullptr : &*found;
}

/// The error message for a name that a command does not know.
std::string problem_with_name(std::string_view name, const Settings& settings) {
  for (const Setting& setting : photile::settings()) {
    if (setting.name == name && has_option(setting)) {
      return fmt::format("give it by {}", option_names(setting).front());
    }
  }
  if (named_in(AllSettings().list(), name)) return "this command does not use it";
  std::vector<std::string_view> names;
  for (const Setting& one : settings) names.push_back(one.name);
  return fmt::format("there is no such setting; the nearest is {}, and photile settings lists all",
                     nearest_word(name, names));
}

/// Its default, or what holds where it is not given.
std::string initial_of(const Setting& setting) {
  if (setting.is_of_quality()) {
    return setting.otherwise.empty() ? "by quality" : "by quality, else " + setting.otherwise;
  }
  const bool has_value = setting.otherwise.empty() && setting.value;
  return has_value ? text_of(setting.value(RenderParameters())) : setting.otherwise;
}

std::string name_in(const std::string& assignment) {
  return assignment.substr(0, assignment.find('='));
}

/// The values that each quality sets, a row for each.
std::string quality_table() {
  std::string text = "| `--quality` |", rule = "|---|";
  for (const Setting& setting : settings()) {
    if (!setting.is_of_quality()) continue;
    text += fmt::format(
        " `{}` |", has_option(setting) ? option_names(setting).front() : std::string(setting.name));
    rule += "--:|";
  }
  text += " the picture |\n" + rule + "---|\n";
  for (const Quality quality : all_qualities) {
    text += fmt::format("| `{}` |", name_of(quality));
    for (const Setting& setting : settings()) {
      if (!setting.is_of_quality()) continue;
      const std::string value = text_of(setting.by_quality[index_of(quality)]);
      text += value == "0" ? " |" : fmt::format(" {} |", value);
    }
    text += fmt::format(" {} |\n", description_of(quality));
  }
  return text;
}

}  // namespace

Settings rendering_settings(RenderParameters& parameters,
                            std::initializer_list<std::string_view> without) {
  Settings list;
  for (const Setting& setting : settings()) {
    if (has_option(setting)) continue;
    if (std::find(without.begin(), without.end(), setting.name) != without.end()) continue;
    list.push_back(setting);
    list.back().assign = [&parameters, &setting](const SettingValue& value) {
      setting.set(parameters, value);
    };
  }
  return list;
}

Settings scene_settings(SceneLoadOptions& options) {
  const char* group = "Scene";
  return {
      bound_word("up", group, Words{{"x", "y", "z", "-x", "-y", "-z"}},
                 "axis of the file that points up", "y, with a warning where it seems to be z",
                 [&options](std::string_view axis) { options.up = axis; }),
      bound_word("units", group, Words{loading::names_of_units()}, "unit of lengths in the file",
                 "m, with a warning where the scene is too small or too large for a room",
                 [&options](std::string_view unit) {
                   options.metres_per_unit = loading::metres_in(unit);
                 }),
      bound_word("scene", group, Text{"NAME or INDEX"}, "scene of a glTF file",
                 "the file's default scene, otherwise the first",
                 [&options](std::string_view scene) { options.scene = scene; }),
      bound_word("hide", group, Text{"GLOB"},
                 "leave out nodes with all below them, meshes, objects and groups whose names "
                 "match; repeatable",
                 "nothing is left out",
                 [&options](std::string_view glob) { options.hidden.emplace_back(glob); }),
      bound_word("glass", group, Text{"MATERIAL=SHARE"},
                 "materials whose names match become clear glass of this visible transmittance "
                 "(Tvis of a data sheet); repeatable",
                 "as in the file",
                 [&options](std::string_view glass) {
                   options.glasses.push_back(MaterialShare::parse(std::string(glass)));
                 }),
      bound_word("portals", group, Text{"auto, off or GLOB"},
                 "windows through which photons of suns and skies start: auto finds them, off uses "
                 "none, a glob names the materials of their panes; repeatable",
                 "auto", [&options](std::string_view glob) { options.portals.emplace_back(glob); }),
      bound_number("north", group, loading::turns, options.situation.north_degrees,
                   "direction of north, clockwise from -z as seen from above", "degrees"),
      bound_number(
          "ground", group, loading::reflectances, options.ground,
          "reflectance of the flat ground below the horizon, lit by --sky and --sun; 0 is black"),
      bound_number("lumen_per_watt", group, PositiveNumbers{}, options.lumen_per_watt,
                   "luminous efficacy: 683, or 179 as in Radiance", "lm/W"),
      bound_number("emissive_scale", group, PositiveNumbers{}, options.emissive_scale,
                   "multiplies emissive materials; 683 corrects files from Blender"),
      bound_number(
          "environment_scale", group, PositiveNumbers{}, options.environment.scale,
          "multiplies the picture of --environment, which is in cd/m2, or W/(m2 sr) for OBJ"),
      bound_number(
          "environment_rotation", group, loading::turns, options.environment.rotation_degrees,
          "clockwise rotation of --environment as seen from above; at 0 its middle lies towards -z",
          "degrees"),
      bound_switch(
          "lambertian", group, options.lambertian,
          "on: dielectrics have no specular lobe, such as the 4% that glTF has by default"),
      bound_switch("allow_outside", group, options.allow_outside,
                   "on: the scene may use files outside its folder"),
  };
}

Settings device_settings(DeviceOptions& options) {
  const char* group = "Device";
  return {
      {.name = "device_memory",
       .unit = "GiB",
       .group = group,
       .help = "maximum memory for all buffers on the device",
       .otherwise = "all memory of the device",
       .range = PositiveNumbers{},
       .assign =
           [&options](const SettingValue& value) {
             constexpr double most = 0x1p33;  // GiB, whose bytes 64 bits count
             options.memory_bytes =
                 static_cast<std::uint64_t>(std::min(std::get<double>(value), most) * 0x1p30);
           }},
      bound_switch("program_cache", group, options.use_program_cache,
                   "take compiled kernels from the cache"),
      bound_switch("profile", group, options.profile, "print the time of every kernel"),
  };
}

Setting display_view_setting(ToneMapping& parameters) {
  std::vector<std::string_view> names;
  for (const DisplayView view : all_display_views) names.push_back(name_of(view));
  return bound_word("view", "Display", Words{std::move(names)},
                    "display transform of PNGs, window and pages: neutral: Khronos PBR Neutral, "
                    "which rolls off highlights; standard: the sRGB curve alone",
                    std::string(name_of(parameters.view)), [&parameters](std::string_view word) {
                      for (const DisplayView view : all_display_views) {
                        if (name_of(view) == word) parameters.view = view;
                      }
                    });
}

Setting white_balance_setting(PictureOptions& options) {
  return bound_switch("white_balance", "Display", options.white_balance,
                      "on: light of the colour of --white, or of the lamps, is shown as white on "
                      "displays and in PNGs; off: colours as they are");
}

Settings display_settings(PictureOptions& options) {
  return {bound_switch("auto_exposure", "Display", options.tone_mapping.automatic_exposure,
                       "on: the log-average luminance becomes 0.36 of white; off: 1 cd/m2 or "
                       "1 W/(m2 sr) becomes white; before --exposure"),
          display_view_setting(options.tone_mapping), white_balance_setting(options),
          bound_word("exr", "Display", Words{{"float", "half", "dwaa"}},
                     "layers of EXRs: float keeps every bit, half 11 significant bits in half the "
                     "space, dwaa is lossy",
                     "float", [&options](std::string_view word) {
                       for (const LayerPrecision one : all_layer_precisions) {
                         if (name_of(one) == word) options.precision = one;
                       }
                     })};
}

Settings glare_settings(double& limit) {
  return {bound_number(
      "glare_limit", "Display", PositiveNumbers{}, limit,
      "limit of --glare: above 100 in cd/m2, otherwise times the mean luminance of the picture")};
}

void assign_named(const Settings& settings, const std::string& assignment) {
  const std::string name = name_in(assignment);
  const Setting* setting = named_in(settings, name);
  if (!setting)
    throw UsageError(fmt::format("--set {}: {}", name, problem_with_name(name, settings)));
  if (name.size() == assignment.size()) {
    throw UsageError(
        fmt::format("--set {0}: has no value; give {0}={1}", name, type_name(setting->range)));
  }
  const std::string text = assignment.substr(name.size() + 1);
  const auto value = parse_value(text, setting->range);
  if (!value) {
    throw UsageError(fmt::format("--set {}: {}", assignment, out_of_range(text, setting->range)));
  }
  setting->assign(*value);
}

void add_set_option(CLI::App& command, std::initializer_list<Settings> settings) {
  Settings all;
  for (const Settings& some : settings) all.insert(all.end(), some.begin(), some.end());
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [all](const std::vector<std::string>& assignments) {
            for (const std::string& assignment : assignments) assign_named(all, assignment);
          },
          "set a setting by its name, such as radius=0.1; photile settings lists them; repeatable")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group("Settings");
}

std::vector<std::string> names_set(const CLI::App& command) {
  std::vector<std::string> names;
  if (command.count("--set") == 0) return names;
  for (const std::string& assignment : command.get_option("--set")->results()) {
    names.push_back(name_in(assignment));
  }
  return names;
}

bool is_of_photon_maps(std::string_view name) {
  const AllSettings all;
  const Setting* setting = named_in(all.list(), name);
  return setting && (setting->group == "Photons" || setting->group == "Estimate" ||
                     setting->group == "Device");
}

std::string remedy_for_option(const std::string& argument, const std::string& next) {
  if (!argument.starts_with("--")) return {};
  const std::string option = name_in(argument);
  std::string name = option.substr(2);
  std::replace(name.begin(), name.end(), '-', '_');
  const AllSettings all;
  const auto& list = all.list();
  const auto setting = std::find_if(list.begin(), list.end(), [&](const Setting& one) {
    return one.name == name || one.name == name + "_degrees";
  });
  if (setting == list.end()) return {};
  const std::string text =
      option.size() < argument.size() ? argument.substr(option.size() + 1) : next;
  const bool fits = parse_value(text, setting->range).has_value();
  return fmt::format("{} is a setting: --set {}={}", option, setting->name,
                     fits ? text : type_name(setting->range));
}

void add_settings(CLI::App& command, RenderParameters& parameters,
                  std::initializer_list<std::string_view> without) {
  for (const Setting& setting : settings()) {
    if (!has_option(setting) || setting.option == "size") continue;
    if (std::find(without.begin(), without.end(), setting.name) != without.end()) continue;
    add(command, parameters, setting);
  }
}

void add_setting(CLI::App& command, RenderParameters& parameters, std::string_view name) {
  add(command, parameters, setting_named(name));
}

std::string option_of(const Setting& setting) {
  return has_option(setting) ? option_names(setting).back() : std::string(setting.name);
}

nlohmann::json settings_json(const RenderParameters& parameters, bool all) {
  nlohmann::json result = nlohmann::json::object();
  for (const Setting& setting : settings()) {
    if (!all && !is_of_any_integrator(setting)) continue;
    std::visit([&](const auto& value) { result[std::string(setting.name)] = value; },
               setting.value(parameters));
  }
  return result;
}

std::string options_text(const RenderParameters& parameters,
                         std::initializer_list<std::string_view> without) {
  constexpr std::array always{"photons_emitted", "neighbours", "samples_per_pixel"};
  const auto is_out = [&](std::string_view name) {
    return std::find(without.begin(), without.end(), name) != without.end();
  };
  std::string text;
  for (const char* name : always) {
    if (is_out(name)) continue;
    const Setting& setting = setting_named(name);
    text += fmt::format("{}{} {}", text.empty() ? "" : " ", option_names(setting).front(),
                        text_of(setting.value(parameters)));
  }
  const RenderParameters usual;
  for (const Setting& setting : settings()) {
    if (has_option(setting) || is_out(setting.name)) continue;
    const SettingValue value = setting.value(parameters);
    // Values that a quality sets have to be printed to override another quality.
    const bool said =
        setting.is_of_quality() ? contains(setting.range, value) : value != setting.value(usual);
    if (!said) continue;
    text += fmt::format(" --set {}={}", setting.name, text_of(value));
  }
  return text;
}

std::string settings_text() {
  std::string text, group;
  const AllSettings all;
  for (const Setting& one : all.list()) {
    if (group != one.group) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", one.group);
    group = one.group;
    text +=
        fmt::format("  {:<21} {}\n  {:<21}   {}{}{}; default: {}\n", one.name, one.help, "",
                    text_of(one.range), one.unit.empty() ? "" : ", ", one.unit, initial_of(one));
  }
  return text;
}

std::string settings_markdown() {
  std::string text =
      "| setting | meaning | values | default | read by |\n"
      "|---|---|---|---|---|\n";
  std::string_view group;
  const AllSettings all;
  for (const Setting& one : all.list()) {
    if (group != one.group) text += fmt::format("| **{}** | | | | |\n", one.group);
    group = one.group;
    text +=
        fmt::format("| `{}` | {} | {}{}{} | {} | {} |\n", one.name, one.help, text_of(one.range),
                    one.unit.empty() ? "" : ", ", one.unit, initial_of(one), one.reader);
  }
  return text + "\n" + quality_table();
}

}  // namespace photile::app
