#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/command/described_command.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/version.hpp"

namespace photile::app {
namespace {

/// Text as man(7) takes it: a hyphen that can be copied, no accidental requests.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'' && result.empty()) {
      result += "\\(aq";
    } else if (c == '.' && result.empty()) {
      result += "\\&.";
    } else {
      result += c == '\n' ? ' ' : c;
    }
  }
  return result;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

/// "-o, --output FILE ...": its names, and what follows them.
std::string heading_of(const DescribedOption& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) {
    names.push_back(option.positional ? italic(name) : bold(name));
  }
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (!option.positional && !option.value.empty()) text += " " + italic(option.value);
  return text + (option.repeatable ? " ..." : "");
}

std::string entry_of(const DescribedOption& option) {
  std::string text = fmt::format(".TP\n{}\n{}", heading_of(option), roff(option.help));
  if (!option.default_value.empty())
    text += fmt::format(" (default: {})", roff(option.default_value));
  return text + "\n";
}

/// Options by the groups of the help, each under its title.
std::string options_text(const DescribedCommand& command) {
  std::vector<std::string> groups;
  for (const DescribedOption& option : command.options) {
    if (option.positional) continue;
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) {
      groups.push_back(option.group);
    }
  }
  std::string text;
  for (const std::string& group : groups) {
    text += group == "Options" ? ".SH OPTIONS\n" : fmt::format(".SS {}\n", roff(group));
    for (const DescribedOption& option : command.options) {
      if (!option.positional && option.group == group) text += entry_of(option);
    }
  }
  return text;
}

std::string exit_codes() {
  std::string text = ".SH EXIT STATUS\n";
  for (const ExitCode code : all_exit_codes) {
    text += fmt::format(".TP\n{}\n{}\n", bold(std::to_string(static_cast<int>(code))),
                        roff(std::string(meaning_of(code))));
  }
  return text;
}

}  // namespace

std::string manual_page(const DescribedCommand& photile, const DescribedCommand* subcommand) {
  const DescribedCommand& command = subcommand ? *subcommand : photile;
  const std::string name = subcommand ? photile.name + "-" + subcommand->name : photile.name;
  std::string title = name, calling = subcommand ? photile.name + " " + subcommand->name : name;
  std::transform(title.begin(), title.end(), title.begin(), [](char c) { return std::toupper(c); });

  std::string text = fmt::format(".TH {} 1 \"\" \"photile {}\" \"User Commands\"\n.ad l\n.nh\n",
                                 roff(title), version_number());
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(command.help));
  text += fmt::format(".SH SYNOPSIS\n{} [{}]", bold(calling), italic("OPTION") + "...");
  if (!subcommand) text += " " + italic("COMMAND") + " ...";
  for (const DescribedOption& option : command.options) {
    if (option.positional) text += " " + italic(option.names.front());
  }
  text += "\n";
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\nEach has a page of its own, such as photile\\-render(1).\n";
    for (const DescribedCommand& one : command.commands) {
      text += fmt::format(".TP\n{}\n{}\n", bold(one.name), roff(one.help));
    }
  }
  const bool has_arguments =
      std::any_of(command.options.begin(), command.options.end(),
                  [](const DescribedOption& option) { return option.positional; });
  if (has_arguments) {
    text += ".SH ARGUMENTS\n";
    for (const DescribedOption& option : command.options) {
      if (option.positional) text += entry_of(option);
    }
  }
  text += options_text(command) + exit_codes();
  if (subcommand) text += ".SH SEE ALSO\nphotile(1)\n";
  return text;
}

}  // namespace photile::app
