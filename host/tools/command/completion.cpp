#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>

#include "photile/errors.hpp"
#include "tools/command/described_command.hpp"

namespace photile::app {
namespace {

std::vector<std::string> names_of(const std::vector<DescribedCommand>& commands) {
  std::vector<std::string> names;
  for (const DescribedCommand& command : commands) names.push_back(command.name);
  return names;
}

/// In single quotes, as every shell takes it.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// The options, one line of the help each, of a command.
void for_each_option(const DescribedCommand& command,
                     const std::function<void(const DescribedOption&)>& visit) {
  for (const DescribedOption& option : command.options) {
    if (!option.positional) visit(option);
  }
}

std::string bash(const DescribedCommand& photile) {
  std::string text =
      "# bash completion of photile; printed by `photile --completion bash`.\n"
      "_photile() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command='' i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }\n"
      "  done\n"
      "  COMPREPLY=()\n"
      "  local options='' words=''\n"
      "  case $command in\n";
  const auto add = [&](const std::string& pattern, const DescribedCommand& command) {
    std::vector<std::string> options;
    std::string cases;
    for_each_option(command, [&](const DescribedOption& option) {
      options.insert(options.end(), option.names.begin(), option.names.end());
      if (option.words.empty()) return;
      cases += fmt::format("        {}) words='{}' ;;\n", fmt::join(option.names, "|"),
                           fmt::join(option.words, " "));
    });
    text += fmt::format("    {})\n      options='{}'\n", pattern, fmt::join(options, " "));
    if (!cases.empty()) text += "      case $before in\n" + cases + "      esac\n";
    text += "      ;;\n";
  };
  for (const DescribedCommand& command : photile.commands) add(command.name, command);
  add("''", photile);
  text += fmt::format(
      "  esac\n"
      "  if [[ $words ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "  elif [[ $word == -* ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
      "  elif [[ ! $command ]]; then\n"
      "    COMPREPLY=($(compgen -W '{}' -- \"$word\"))\n"
      "  fi\n"
      "}}\n"
      "# Where it finds nothing, files are completed.\n"
      "complete -o default -F _photile photile\n",
      fmt::join(names_of(photile.commands), " "));
  return text;
}

/// Text in a specification of _arguments, whose brackets and colons mean something.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh(const DescribedCommand& photile) {
  std::string text = "#compdef photile\n# Printed by `photile --completion zsh`.\n";
  const auto add = [&](const DescribedCommand& command) {
    text += "    _arguments -s";
    for_each_option(command, [&](const DescribedOption& option) {
      for (const std::string& name : option.names) {
        std::string spec =
            (option.repeatable ? "*" : "") + name + "[" + zsh_text(option.help) + "]";
        if (!option.value.empty()) {
          spec += ":" + zsh_text(option.value) + ":";
          if (!option.words.empty()) spec += fmt::format("({})", fmt::join(option.words, " "));
          if (option.takes_file()) spec += "_files";
        }
        text += " \\\n      " + in_quotes(spec);
      }
    });
  };
  text += "local -a commands\ncommands=(\n";
  for (const DescribedCommand& command : photile.commands) {
    text += "  " + in_quotes(command.name + ":" + zsh_text(command.help)) + "\n";
  }
  text +=
      ")\nlocal command=${words[(r)[a-z]*]}\n"
      "[[ $command == photile ]] && command=${${words[2,-1]}[(r)[a-z]*]}\n"
      "case $command in\n";
  for (const DescribedCommand& command : photile.commands) {
    text += "  " + command.name + ")\n";
    add(command);
    text += " \\\n      '*:file:_files'\n    ;;\n";
  }
  text += "  *)\n";
  add(photile);
  text += " \\\n      '1:command:{ _describe command commands }'\n    ;;\nesac\n";
  return text;
}

std::string fish(const DescribedCommand& photile) {
  std::string text = "# fish completion of photile; printed by `photile --completion fish`.\n";
  const std::string all = fmt::format("{}", fmt::join(names_of(photile.commands), " "));
  for (const DescribedCommand& command : photile.commands) {
    text +=
        fmt::format("complete -c photile -f -n 'not __fish_seen_subcommand_from {}' -a {} -d {}\n",
                    all, command.name, in_quotes(command.help));
  }
  const auto add = [&](const std::string& condition, const DescribedCommand& command) {
    for_each_option(command, [&](const DescribedOption& option) {
      text += "complete -c photile -n " + in_quotes(condition);
      for (const std::string& name : option.names) {
        text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.words.empty()) {
        text += fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
      } else if (!option.value.empty()) {
        text += option.takes_file() ? " -r" : " -x";
      }
      text += " -d " + in_quotes(option.help) + "\n";
    });
  };
  add("not __fish_seen_subcommand_from " + all, photile);
  for (const DescribedCommand& command : photile.commands) {
    add("__fish_seen_subcommand_from " + command.name, command);
  }
  return text;
}

}  // namespace

std::string completion(const DescribedCommand& photile, const std::string& shell) {
  if (shell == "bash") return bash(photile);
  if (shell == "zsh") return zsh(photile);
  if (shell == "fish") return fish(photile);
  throw UsageError(fmt::format("--completion: '{}' is not one of bash, zsh, fish", shell));
}

}  // namespace photile::app
