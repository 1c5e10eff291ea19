#include "tools/command/described_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

namespace photile::app {
namespace {

/// "a|b|c" and ":{a,b,c}" as words; none where the text is something else.
std::vector<std::string> words_of(const std::string& type) {
  std::string list = type;
  char separator = '|';
  const std::size_t open = type.find('{');
  if (open != std::string::npos && type.find('}') != std::string::npos) {
    list = type.substr(open + 1, type.find('}') - open - 1);
    separator = ',';
  }
  if (list.find(separator) == std::string::npos) return {};
  std::vector<std::string> words = CLI::detail::split(list, separator);
  // "X|auto", "POWER|xFACTOR": capitals stand for a value.
  const bool literal = std::all_of(words.begin(), words.end(), [](const std::string& word) {
    return std::none_of(word.begin(), word.end(),
                        [](unsigned char c) { return std::isupper(c) || c == '#'; });
  });
  return literal ? words : std::vector<std::string>{};
}

/// "FILE", "auto|uniform|..."
std::string value_of(const CLI::Option& option) {
  if (option.get_type_size() == 0 || option.get_expected_max() == 0) return "";
  std::string type = option.get_type_name();
  const std::size_t open = type.find(":{");
  if (open == 0) {
    type = type.substr(2, type.size() - 3);
    std::replace(type.begin(), type.end(), ',', '|');
  }
  return type.empty() ? "VALUE" : type;
}

DescribedOption describe(const CLI::Option& option) {
  DescribedOption described;
  described.positional = option.get_positional();
  if (described.positional) {
    described.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  }
  described.value = value_of(option);
  described.default_value = option.get_default_str();
  described.help = option.get_description();
  described.group = option.get_group();
  described.words = words_of(option.get_type_name());
  described.required = option.get_required();
  described.repeatable = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  return described;
}

}  // namespace

DescribedCommand describe(const CLI::App& app) {
  DescribedCommand command{app.get_name(), app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    command.options.push_back(describe(*option));
  }
  for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
    command.commands.push_back(describe(*subcommand));
  }
  return command;
}

}  // namespace photile::app
