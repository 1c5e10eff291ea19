// The command line as data: what --help prints, for manual pages and for completions of shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace photile::app {

struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional "SCENE"
  std::string value;               ///< "FILE"; "" of a flag
  std::string default_value;       ///< "" = none
  std::string help;
  std::string group;               ///< title in the help
  std::vector<std::string> words;  ///< the only values, where they are words
  bool positional = false;
  bool required = false;
  bool repeatable = false;

  /// Whether a file is named by its value.
  bool takes_file() const { return value.rfind("FILE", 0) == 0 || names.front() == "SCENE"; }
};

struct DescribedCommand {
  std::string name;  ///< "photile", "render"
  std::string help;
  std::vector<DescribedOption> options;  ///< in the order of the help
  std::vector<DescribedCommand> commands;
};

DescribedCommand describe(const CLI::App& app);

/// A manual page in man(7): of `photile` itself where `subcommand` is null, else of one of its
/// commands.
std::string manual_page(const DescribedCommand& photile, const DescribedCommand* subcommand);

/// What completes the command line in a shell: "bash", "zsh" or "fish". Errors: UsageError for
/// another.
std::string completion(const DescribedCommand& photile, const std::string& shell);

}  // namespace photile::app
