// The command line as a whole: parse, run one subcommand, turn errors into exit codes.
#pragma once

namespace photile::app {

/// Runs the command. Never throws: every error becomes one line on stderr and an exit code of
/// photile/errors.hpp.
int run_command_line(int argument_count, const char* const* arguments);

}  // namespace photile::app
