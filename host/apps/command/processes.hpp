// The process that runs the command: its signals, its threads, and those that mpirun or srun have
// started with it.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "photile/communicator.hpp"

namespace photile::app {

/// From now on SIGINT and SIGTERM ask the running command to stop at its next safe point; a second
/// signal ends the process at once. A file-size limit becomes a write error instead of a signal.
/// Errors: those of require_threads.
void handle_signals();

/// True once a signal asked to stop.
bool stop_requested();

/// Throws Interrupted once a signal asked to stop.
void throw_if_stop_requested();

/// While it lives, TBB uses at most `count` threads (0: as many as there are cores), and so does a
/// PoCL device that is opened later, which has no more threads than cores. The picture does not
/// depend on it.
class ThreadLimit {
 public:
  /// Errors: those of require_threads.
  explicit ThreadLimit(int count);
  ~ThreadLimit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Finds out whether mpirun or srun has started this process, and if so loads host/cluster. To be
/// called once, before the command line is read.
/// Errors: UsageError where it has started several, and this build has no MPI, the launcher offers
/// none, or not all have the same version and options (but for --device and --threads).
void join_processes(std::span<const char* const> arguments);

/// Null where this process is on its own.
Communicator* processes();

/// Whether this process reports and writes the result of all.
bool leads();

/// Whether another process has failed, so that the result of this one is not needed. Any thread.
bool other_failed();

/// A folder that is installed with the program, or lies in its build folder.
///   installed   by its path from the program
///   built       by its path from the build folder
std::filesystem::path folder_of_program(const char* installed, const char* built);

/// The values of rank 0, on all ranks. Collective.
std::vector<bool> as_first_says(const std::vector<bool>& own);

/// Errors: UsageError where there are several processes.
///   what   an option or a command
///   remedy   what to do
void refuse_several(const std::string& what, const std::string& remedy);

}  // namespace photile::app
