// What standard error is connected to, and single lines written to it.
#pragma once

#include <string>

namespace photile::app {

bool stderr_is_terminal();

/// Columns of the terminal on standard error; 80 where it does not say.
int terminal_width();

/// Writes `line` and a line feed to standard error.
void print_line(const std::string& line);

/// Writes "photile: error: ..." as one line to standard error; in colour on a terminal unless the
/// environment variable NO_COLOR is set.
void print_error(const std::string& message);

}  // namespace photile::app
