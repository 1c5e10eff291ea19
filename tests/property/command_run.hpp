// The command in the process of the test: starting a process takes longer than most commands do.
#pragma once

#include <string>
#include <vector>

namespace photile::test {

struct CommandRun {
  int exit_code = -1;
  std::string output, errors;  ///< standard output, standard error

  /// Without the end of the last.
  std::vector<std::string> error_lines() const;
};

/// Runs it to its end. Standard output and standard error go to files meanwhile.
CommandRun run_command(const std::vector<std::string>& arguments);

}  // namespace photile::test
