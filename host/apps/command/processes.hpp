// Processes that mpirun or srun have started together.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "photile/communicator.hpp"

namespace photile::app {

/// Finds out whether mpirun or srun has started this process, and if so loads host/cluster. To be
/// called once, before the command line is read.
/// Errors: UsageError where it has started several, and this build has no MPI or the launcher
/// offers none.
void join_processes(std::span<const char* const> arguments);

/// Null where this process is on its own.
Communicator* processes();

/// Whether this process tells and writes what all have made.
bool leads();

/// Whether another process has failed: what this one makes is of no use then. Any thread.
bool other_failed();

/// What rank 0 says, on all ranks. Collective.
std::vector<bool> as_first_says(const std::vector<bool>& own);

/// Errors: UsageError where there are several processes.
///   what   an option or a command
///   remedy   what to do
void refuse_several(const std::string& what, const std::string& remedy);

}  // namespace photile::app
