#include "child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <thread>

#include "held_to_permissions.hpp"

namespace photile::test {
namespace {

using Clock = std::chrono::steady_clock;
/// Ends what hangs; a busy machine may take several times as long as a quiet one.
constexpr auto time_limit = std::chrono::minutes(10);

/// Both ends of what a child writes to and the test reads from.
struct Channel {
  int read_end = -1, write_end = -1;
};

Channel open_pipe() {
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
  return {ends[0], ends[1]};
}

Channel open_terminal() {
  const winsize size{.ws_row = 24, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
  Channel channel;
  REQUIRE(openpty(&channel.read_end, &channel.write_end, nullptr, nullptr, &size) == 0);
  fcntl(channel.read_end, F_SETFD, FD_CLOEXEC);
  return channel;
}

[[noreturn]] void become_photile(const Run& run, const Channel& output, const Channel& errors) {
  int output_file = output.write_end;
  if (!run.standard_output.empty()) output_file = open(run.standard_output.c_str(), O_WRONLY);
  dup2(output_file, STDOUT_FILENO);
  dup2(errors.write_end, STDERR_FILENO);
  // A terminal's own descriptor would keep it open in the child.
  if (errors.write_end > STDERR_FILENO) close(errors.write_end);
  setenv("XDG_CACHE_HOME", PHOTILE_TEST_CACHE, 1);
  setenv("TERM", "xterm", 1);
  for (const auto& [name, value] : run.environment) setenv(name.c_str(), value.c_str(), 1);
  if (run.held_to_permissions) HeldToPermissions::for_good();
  for (const auto& [resource, most] : run.limits) {
    const rlimit limit{most, most};
    setrlimit(resource, &limit);
  }
  // The limit of threads is of a user, and not of root; nobody else runs as this one.
  if (run.limits.contains(RLIMIT_NPROC) && getuid() == 0 && setuid(65'533) != 0) _exit(126);
  std::vector<char*> arguments{const_cast<char*>("photile")};
  for (const auto& argument : run.arguments) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  execv(command().c_str(), arguments.data());
  _exit(127);
}

pid_t start(const Run& run, const Channel& output, const Channel& errors) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) become_photile(run, output, errors);
  close(output.write_end);
  if (errors.write_end != output.write_end) close(errors.write_end);
  return child;
}

/// Appends what can be read now; false at the end of the stream.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> bytes{};
  const ssize_t count = read(descriptor, bytes.data(), bytes.size());
  if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0;  // a terminal whose other end is closed gives an error, not an end
}

void send_signal(const Run& run, pid_t child) {
  std::this_thread::sleep_for(run.signal_delay);
  kill(child, run.signal);
}

void read_until_closed(const Run& run, pid_t child, int output, int errors, Outcome& outcome) {
  std::array<pollfd, 2> streams{pollfd{output, POLLIN, 0}, pollfd{errors, POLLIN, 0}};
  const auto deadline = Clock::now() + time_limit;
  bool signalled = run.signal_when.empty();
  if (signalled && run.signal_delay.count() > 0) send_signal(run, child);
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    poll(streams.data(), streams.size(), 1000);
    if (Clock::now() > deadline) {
      kill(child, SIGKILL);
      FAIL("photile did not end in time; it had printed: " << outcome.errors);
    }
    for (std::size_t i = 0; i < streams.size(); ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      if (!read_some(streams[i].fd, i == 0 ? outcome.output : outcome.errors)) streams[i].fd = -1;
    }
    if (!signalled && outcome.errors.find(run.signal_when) != std::string::npos) {
      send_signal(run, child);
      signalled = true;
    }
  }
  if (!signalled) FAIL("photile never printed '" << run.signal_when << "': " << outcome.errors);
}

}  // namespace

std::string command() {
  const char* other = std::getenv("PHOTILE_COMMAND");
  return other == nullptr ? PHOTILE_COMMAND : other;
}

std::vector<std::string> Outcome::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(errors);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Outcome run_photile(const Run& run) {
  const Channel output = open_pipe();
  const Channel errors = run.terminal ? open_terminal() : open_pipe();
  const pid_t child = start(run, output, errors);
  Outcome outcome;
  read_until_closed(run, child, output.read_end, errors.read_end, outcome);
  close(output.read_end);
  close(errors.read_end);
  int status = 0;
  rusage usage{};
  REQUIRE(wait4(child, &status, 0, &usage) == child);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.kilobytes = usage.ru_maxrss;
  return outcome;
}

Outcome run_photile(const std::vector<std::string>& arguments) {
  return run_photile(Run{.arguments = arguments});
}

Outcome succeed(const Run& run) {
  Outcome outcome = run_photile(run);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  return outcome;
}

Outcome succeed(const std::vector<std::string>& arguments) {
  return succeed(Run{.arguments = arguments});
}

pid_t start_photile(const std::vector<std::string>& arguments) {
  const Channel nowhere{-1, open("/dev/null", O_WRONLY | O_CLOEXEC)};
  return start({.arguments = arguments}, nowhere, nowhere);
}

std::string only_error(const Outcome& outcome, int exit_code) {
  INFO(outcome.errors);
  const auto lines = outcome.error_lines();
  REQUIRE(lines.size() == 1);
  return last_error(outcome, exit_code);
}

std::string last_error(const Outcome& outcome, int exit_code) {
  INFO(outcome.errors);
  CHECK(outcome.exit_code == exit_code);
  const auto lines = outcome.error_lines();
  REQUIRE_FALSE(lines.empty());
  const std::string prefix = "photile: error: ";
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    CHECK(lines[i].find(prefix) == std::string::npos);
  }
  REQUIRE(lines.back().substr(0, prefix.size()) == prefix);
  return lines.back().substr(prefix.size());
}

}  // namespace photile::test
