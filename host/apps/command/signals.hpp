// Stopping on SIGINT and SIGTERM.
#pragma once

namespace photile::app {

/// From now on SIGINT and SIGTERM ask the running command to stop at its next safe point; a second
/// signal ends the process at once. A file-size limit becomes a write error instead of a signal.
void handle_signals();

/// True once a signal asked to stop.
bool stop_requested();

/// Throws Interrupted once a signal asked to stop.
void throw_if_stop_requested();

}  // namespace photile::app
