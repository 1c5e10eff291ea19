// Progress on standard error: a bar on a terminal, plain lines otherwise.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "command/progress_bar.hpp"
#include "photile/progress.hpp"
#include "photile/statistics.hpp"

namespace photile::app {

/// Draws the current stage from a thread of its own, so that the clock runs on while a stage waits
/// for the device. Cancelled by SIGINT and SIGTERM (app/signals.hpp). One stage at a time.
class TerminalProgress : public Progress {
 public:
  /// `quiet`: stages and notes print nothing.
  explicit TerminalProgress(bool quiet);
  /// Removes the bar of a stage that was left by an exception.
  ~TerminalProgress() override;

  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override;
  void advance(std::uint64_t count) override;
  void end() override;
  void note(const std::string& line) override;
  bool cancelled() const override;

 private:
  enum class Style { quiet, lines, bar };

  void keep_drawing(std::stop_token stop);
  void draw();                    // needs mutex_
  void erase();                   // needs mutex_
  StageProgress current() const;  // needs mutex_

  const Style style_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool active_ = false;  // a stage is under way
  bool drawn_ = false;   // its bar is on the terminal
  StageProgress stage_;  // `done` and `seconds` are filled by current()
  std::atomic<std::uint64_t> done_{0};
  Stopwatch stopwatch_;
  std::jthread drawer_;  // last: it uses all of the above
};

}  // namespace photile::app
