#include "command/signals.hpp"

#include <atomic>
#include <csignal>

#include "photile/errors.hpp"

namespace photile::app {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void request_stop(int) { stop.store(true, std::memory_order_relaxed); }

}  // namespace

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  // SA_RESETHAND: the second signal has its default action, for a stage that takes too long to
  // stop.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool stop_requested() { return stop.load(std::memory_order_relaxed); }

void throw_if_stop_requested() {
  if (stop_requested()) throw Interrupted();
}

}  // namespace photile::app
