// Runs the command `photile` as a child process and keeps what it printed.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace photile::test {

/// Exit codes of photile (photile/errors.hpp).
inline constexpr int failure = 1, usage = 2, bad_input = 3, no_device = 4;

/// The words of a command line: literals are split at blanks, strings are a word each, lists as
/// many as they hold.
template <class... Parts>
std::vector<std::string> typed(const Parts&... parts) {
  std::vector<std::string> all;
  const auto append = [&]<class Part>(const Part& part) {
    if constexpr (std::is_same_v<Part, std::string>) {
      all.push_back(part);
    } else if constexpr (std::is_same_v<Part, std::vector<std::string>>) {
      all.insert(all.end(), part.begin(), part.end());
    } else {
      std::istringstream text(part);
      for (std::string word; text >> word;) all.push_back(word);
    }
  };
  (append(parts), ...);
  return all;
}

/// The command under test: that of the build, or the one that PHOTILE_COMMAND names.
std::string command();

struct Run {
  std::vector<std::string> arguments{};
  std::map<std::string, std::string> environment{};  ///< on top of the test's own
  bool terminal = false;                             ///< standard error is a terminal, 100 columns
  std::string standard_output{};                     ///< a file to write it to; "" = keep it
  bool held_to_permissions = false;                  ///< root, too, reads no file that denies it
  std::map<decltype(RLIMIT_AS), std::uint64_t> limits{};  ///< of setrlimit
  std::string signal_when{};  ///< once standard error holds this text, `signal` is sent
  std::chrono::milliseconds signal_delay{0};  ///< after that text, or after the start without one
  int signal = SIGINT;
};

struct Outcome {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
  long kilobytes = 0;  ///< resident, at most

  /// Lines of standard error.
  std::vector<std::string> error_lines() const;
};

/// Runs photile to its end. Ends it after two minutes, so that a hang fails and does not block.
Outcome run_photile(const Run& run);
Outcome run_photile(const std::vector<std::string>& arguments);

/// Runs photile, and fails the test with what it printed where it does not succeed.
Outcome succeed(const Run& run);
Outcome succeed(const std::vector<std::string>& arguments);

/// Starts photile, which prints nowhere, for a test that waits for it or ends it itself.
pid_t start_photile(const std::vector<std::string>& arguments);

/// The one line that a failed command prints: fails the test unless standard error is exactly one
/// line "photile: error: ..." and the exit code is `exit_code`.
std::string only_error(const Outcome& outcome, int exit_code);

/// The last line of standard error, where progress came before: fails the test unless it is the
/// only line with "photile: error: " and the exit code is `exit_code`.
std::string last_error(const Outcome& outcome, int exit_code);

}  // namespace photile::test
