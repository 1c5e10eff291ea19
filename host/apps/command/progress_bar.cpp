#include "command/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "command/number_format.hpp"

namespace photile::app {
namespace {

/// 0 to 1; 0 where the total is not known. A stage may report more units than it announced.
double fraction(const StageProgress& progress) {
  if (progress.total == 0) return 0;
  return std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(progress.total));
}

/// "3.8 s", or "?" before anything is known.
std::string remaining(const StageProgress& progress) {
  const double done = fraction(progress);
  return done > 0 ? format_seconds(progress.seconds * (1 - done) / done) : "?";
}

/// "1.9M paths/s"; empty before anything is known.
std::string rate(const StageProgress& progress) {
  if (progress.done == 0 || progress.seconds <= 0) return {};
  const double per_second = static_cast<double>(progress.done) / progress.seconds;
  return fmt::format("{} {}/s", format_count(per_second), progress.unit);
}

}  // namespace

std::string progress_bar(const StageProgress& progress, int width) {
  const std::string head = fmt::format("{:<20} ", progress.stage);
  std::string tail;
  int bar_width = 0;
  if (progress.total == 0) {
    tail = fmt::format("{}  {}", format_seconds(progress.seconds), rate(progress));
  } else {
    tail = fmt::format(" {:3.0f}%  {} | {}  {}", 100 * fraction(progress),
                       format_seconds(progress.seconds), remaining(progress), rate(progress));
    // The bar takes what the text leaves, brackets and last column not counted.
    bar_width = std::min(40, width - 3 - static_cast<int>(head.size() + tail.size()));
  }
  std::string bar;
  if (bar_width >= 5) {
    const int filled = static_cast<int>(fraction(progress) * bar_width);
    bar = '[' + std::string(static_cast<std::size_t>(filled), '=') +
          std::string(static_cast<std::size_t>(bar_width - filled), ' ') + ']';
    if (filled < bar_width) bar[static_cast<std::size_t>(filled) + 1] = '>';
  }
  return (head + bar + tail).substr(0, static_cast<std::size_t>(std::max(0, width - 1)));
}

std::string progress_text(const StageProgress& progress) {
  const std::string elapsed = format_seconds(progress.seconds);
  if (progress.total == 0) return fmt::format("{}: {}", progress.stage, elapsed);
  return fmt::format("{}: {:.0f}%, {}, {} left", progress.stage, 100 * fraction(progress), elapsed,
                     remaining(progress));
}

std::string completed_text(const StageProgress& progress) {
  const std::string speed = rate(progress);
  return fmt::format("{}: {}{}{}", progress.stage, format_seconds(progress.seconds),
                     speed.empty() ? "" : ", ", speed);
}

}  // namespace photile::app
