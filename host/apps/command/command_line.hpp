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

void add_render_command(CLI::App& photile);
void add_relight_command(CLI::App& photile);
void add_compare_command(CLI::App& photile);
void add_measure_command(CLI::App& photile);
void add_daylight_command(CLI::App& photile);
void add_glare_command(CLI::App& photile);
void add_ies_command(CLI::App& photile);
void add_settings_command(CLI::App& photile);
void add_trade_command(CLI::App& photile);
void add_devices_command(CLI::App& photile);
void add_info_command(CLI::App& photile);
void add_validate_command(CLI::App& photile);
void add_trace_command(CLI::App& photile);
void add_walk_command(CLI::App& photile);
void add_view_command(CLI::App& photile);
void add_bake_command(CLI::App& photile);
void add_publish_command(CLI::App& photile);
void add_help_command(CLI::App& photile);

/// "0.1.0"
std::string version_number();

/// One line for photile and its commit, one for each thing it was built with.
std::string version_text();

}  // namespace photile::app
