// The command line as a whole: its subcommands, and what turns errors into exit codes.
#pragma once

#include <string>

#include "photile/errors.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Runs the command. Never throws: every error becomes one line on stderr and an exit code of
/// photile/errors.hpp.
int run_command_line(int argument_count, const char* const* arguments);

/// Documented in docs/reference/commands.md.
enum class ExitCode : int {
  success = 0,        ///< the output is complete
  failure = 1,        ///< unwritable output, disk full, validation failed, internal error
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

using AddCommand = void(CLI::App& photile);
AddCommand add_import_command, add_render_command, add_relight_command, add_compare_command,
    add_measure_command, add_daylight_command, add_glare_command, add_outlook_command,
    add_layout_command, add_trade_command, add_devices_command, add_info_command,
    add_settings_command, add_ies_command, add_validate_command, add_walk_command,
    add_trace_command, add_view_command, add_bake_command, add_publish_command, add_help_command;

/// "0.1.0"
std::string version_number();

/// One line for photile and its commit, one for each thing it was built with.
std::string version_text();

}  // namespace photile::app
