// Standard error: single lines, progress as a bar on a terminal (as plain lines otherwise), and
// numbers as people read them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"

namespace photile::app {

bool stderr_is_terminal();

/// Columns of the terminal on standard error; 80 where they are not known.
int terminal_width();

/// Writes `line` and a line feed to standard error, after flushing standard output.
void print_line(const std::string& line);

/// Writes "photile: error: ..." as one line to standard error; in colour on a terminal unless the
/// environment variable NO_COLOR is set.
void print_error(const std::string& message);

/// The progress of a stage.
struct StageProgress {
  std::string stage;
  std::uint64_t done = 0;
  std::uint64_t total = 0;  ///< 0 where it is not known
  std::string unit;         ///< what is counted: "paths", "triangles", ...
  double seconds = 0;       ///< since the stage began
};

/// "trace photons  [=====>    ]  52%  4.1 s | 3.8 s  1.9M paths/s" (elapsed | remaining), at most
/// `width` - 1 characters: a full last column would wrap on some terminals.
std::string progress_bar(const StageProgress& progress, int width);

/// "trace photons: 52%, 4.1 s, 3.8 s left", for an output that is no terminal.
std::string progress_text(const StageProgress& progress);

/// "trace photons: 7.90 s, 1.9M paths/s", once the stage is complete.
std::string completed_text(const StageProgress& progress);

/// Draws the current stage from its own thread, so that the clock advances while a stage waits for
/// the device. Cancelled by SIGINT and SIGTERM (processes.hpp). One stage at a time.
class TerminalProgress : public Progress {
 public:
  /// `quiet`: stages and notes print nothing; warnings do, on the first of several processes.
  explicit TerminalProgress(bool quiet);
  /// Removes the bar of a stage that was left by an exception.
  ~TerminalProgress() override;

  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override;
  void advance(std::uint64_t count) override;
  void end() override;
  void note(const std::string& line) override;
  void warn(const std::string& line) override;
  bool cancelled() const override;

 private:
  enum class Style { quiet, lines, bar };

  void keep_drawing(std::stop_token stop);
  void draw();   // needs mutex_
  void erase();  // needs mutex_
  void print_above(const std::string& line);
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

/// 950, "1.9k", "4.0M", "1.2G": three digits at most before the point.
std::string format_count(double count);

/// "512 B", "1.5 KiB", "340.0 MiB"
std::string format_bytes(std::uint64_t bytes);

/// "0.12 s", "12.3 s", "2 min 05 s", "1 h 02 min"
std::string format_seconds(double seconds);

/// "800 lm" or "5 W"
std::string format_power(double power, PowerUnit unit);

/// "800 lm", and of a light that its scene counts in watts "5 W (3,415 lm)".
std::string format_power_in_lumens(double power, PowerUnit unit, double lumen_per_watt);

}  // namespace photile::app
