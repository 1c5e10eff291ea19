// The exit codes of the command.
#pragma once

#include <array>
#include <string_view>

#include "photile/errors.hpp"

namespace photile::app {

/// Documented in docs/command-line.md.
enum class ExitCode : int {
  success = 0,
  failure = 1,
  usage = 2,
  input = 3,
  device = 4,
  interrupted = 130
};
inline constexpr std::array all_exit_codes = {ExitCode::success, ExitCode::failure,
                                              ExitCode::usage,   ExitCode::input,
                                              ExitCode::device,  ExitCode::interrupted};

/// When the command ends with it.
constexpr std::string_view meaning_of(ExitCode code) {
  switch (code) {
    case ExitCode::success:
      return "the output is complete";
    case ExitCode::failure:
      return "run-time failure: unwritable output, disk full, internal error";
    case ExitCode::usage:
      return "unknown option, value out of range, unknown light name";
    case ExitCode::input:
      return "scene or image missing, unreadable, malformed, without lights or geometry";
    case ExitCode::device:
      return "no OpenCL device, kernel build failure, device out of memory";
    case ExitCode::interrupted:
      return "stopped by the user (SIGINT); earlier results are kept";
  }
  return "";
}

inline ExitCode exit_code_of(const Error& error) {
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return ExitCode::usage;
  if (dynamic_cast<const InputError*>(&error) != nullptr) return ExitCode::input;
  if (dynamic_cast<const DeviceError*>(&error) != nullptr) return ExitCode::device;
  if (dynamic_cast<const Interrupted*>(&error) != nullptr) return ExitCode::interrupted;
  return ExitCode::failure;
}

}  // namespace photile::app
