#include "command/setting_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <vector>

#include "command/quality_options.hpp"
#include "command/validators.hpp"

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

/// Of a value in the help: "N", "M", "naive|triangle|patch|auto".
std::string type_name(const Setting& setting) {
  if (const auto* words = std::get_if<Words>(&setting.range)) {
    return fmt::format("{}", fmt::join(words->words, "|"));
  }
  if (std::holds_alternative<WholeNumbers>(setting.range)) return "N";
  if (setting.unit.empty()) return "X";
  std::string unit(setting.unit);
  std::transform(unit.begin(), unit.end(), unit.begin(), [](char c) { return std::toupper(c); });
  return unit;
}

void add(CLI::App& command, RenderParameters& parameters, const Setting& setting) {
  if (setting.option.empty()) return;
  std::string help(setting.help);
  if (!setting.otherwise.empty()) help += fmt::format("; default: {}", setting.otherwise);
  CLI::Option* option = command
                            .add_option_function<std::string>(
                                fmt::format("{}", fmt::join(option_names(setting), ",")),
                                [&parameters, &setting](const std::string& text) {
                                  setting.set(parameters, *parse_value(text, setting.range));
                                },
                                help)
                            ->type_name(type_name(setting))
                            ->transform(within(setting.range))
                            ->group(std::string(setting.group));
  if (setting.is_given(parameters)) option->default_str(text_of(setting.value(parameters)));
}

std::string default_text(const Setting& setting) {
  if (setting.is_of_quality()) return "by [quality](#quality)";
  return setting.otherwise.empty() ? text_of(setting.value(RenderParameters{}))
                                   : std::string(setting.otherwise);
}

/// A row of the documentation.
std::string table_row(const Setting& setting) {
  const std::string unit = setting.unit.empty() ? "" : fmt::format(", {}", setting.unit);
  return fmt::format("| `{}` | {} | {}{} | {} | {} |\n", fmt::join(option_names(setting), "`, `"),
                     setting.help, text_of(setting.range), unit, default_text(setting),
                     setting.reader);
}

std::vector<std::string_view> quality_names() {
  std::vector<std::string_view> names;
  for (const Quality quality : all_qualities) names.push_back(name_of(quality));
  return names;
}

/// What each sets, a row for each.
std::string quality_table() {
  std::string text = "| `--quality` |", rule = "|---|";
  for (const Setting& setting : settings()) {
    if (!setting.is_of_quality()) continue;
    text += fmt::format(" `{}` |", option_names(setting).front());
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

void add_settings(CLI::App& command, RenderParameters& parameters,
                  std::initializer_list<std::string_view> without) {
  for (const Setting& setting : settings()) {
    if (std::find(without.begin(), without.end(), setting.name) != without.end()) continue;
    add(command, parameters, setting);
  }
}

void add_setting(CLI::App& command, RenderParameters& parameters, std::string_view name) {
  add(command, parameters, setting_named(name));
}

std::string option_of(const Setting& setting) {
  return setting.option.empty() ? std::string(setting.name) : option_names(setting).back();
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

std::string options_text(const RenderParameters& parameters) {
  constexpr std::array always{"photons_emitted", "neighbours", "samples_per_pixel"};
  std::string text;
  const auto append = [&](const Setting& setting) {
    text += fmt::format("{}{} {}", text.empty() ? "" : " ", option_names(setting).front(),
                        text_of(setting.value(parameters)));
  };
  for (const char* name : always) append(setting_named(name));
  for (const Setting& setting : settings()) {
    const bool shown = std::find(always.begin(), always.end(), setting.name) != always.end();
    const bool usual = setting.value(parameters) == setting.value(RenderParameters{});
    if (!shown && !usual && !setting.option.empty()) append(setting);
  }
  return text;
}

std::string settings_table() {
  std::string text =
      "| option | meaning | values | default | read by |\n"
      "|---|---|---|---|---|\n";
  std::string_view group;
  for (const Setting& setting : settings()) {
    if (setting.option.empty()) continue;
    if (group != setting.group) text += fmt::format("| **{}** | | | | |\n", setting.group);
    group = setting.group;
    text += table_row(setting);
  }
  text += fmt::format("| **Quality** | | | | |\n| `--quality` | {} | one of {} | good | all |\n",
                      quality_help, fmt::join(quality_names(), ", "));
  for (const GoalOption& goal : goal_options()) {
    text += fmt::format("| `--{}` | {} | {} | | all |\n", goal.option, goal.help,
                        goal.type == "TIME" ? "such as `33ms`, `10s`, `2min`" : "such as `1.5%`");
  }
  return text + "\n### Quality\n\n" + quality_table();
}

}  // namespace photile::app
