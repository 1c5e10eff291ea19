// The exit codes of the command.
#pragma once

#include "photile/errors.hpp"

namespace photile::app {

/// Documented in docs/command-line.md.
enum class ExitCode : int {
  success = 0,        ///< the output is complete
  failure = 1,        ///< unwritable output, disk full, internal error
  usage = 2,          ///< unknown option, value out of range, unknown light name
  input = 3,          ///< scene or image missing, unreadable, malformed, without lights or geometry
  device = 4,         ///< no OpenCL device, kernel build failure, device out of memory
  interrupted = 130,  ///< stopped by the user (SIGINT); earlier results are kept
};

inline ExitCode exit_code_of(const Error& error) {
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return ExitCode::usage;
  if (dynamic_cast<const InputError*>(&error) != nullptr) return ExitCode::input;
  if (dynamic_cast<const DeviceError*>(&error) != nullptr) return ExitCode::device;
  if (dynamic_cast<const Interrupted*>(&error) != nullptr) return ExitCode::interrupted;
  return ExitCode::failure;
}

}  // namespace photile::app
