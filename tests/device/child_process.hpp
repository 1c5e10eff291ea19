// Runs a program with an environment of its own and collects what it prints.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace photile::test {

struct ChildResult {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// Changes to this process's environment: a value, or none to remove the variable.
using ChildEnvironment = std::map<std::string, std::optional<std::string>>;

/// A started program; `wait` may be called once. Several may run at a time.
class ChildProcess {
 public:
  /// `command[0]` is the path of the program. Throws std::runtime_error if it cannot start.
  explicit ChildProcess(const std::vector<std::string>& command,
                        const ChildEnvironment& environment = {});
  /// Waits for the end. A program that runs longer than 120 s is killed (SIGKILL).
  ChildResult wait();

 private:
  int pid_ = 0;
  int output_ = -1, errors_ = -1;  ///< unlinked temporary files
};

inline ChildResult run_child(const std::vector<std::string>& command,
                             const ChildEnvironment& environment = {}) {
  return ChildProcess(command, environment).wait();
}

}  // namespace photile::test
