#include "command/terminal_progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "command/processes.hpp"
#include "common/foreign_text.hpp"
#include "report/tables.hpp"

namespace photile::app {

namespace {

bool use_color() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  return stderr_is_terminal() && !dumb && (no_color == nullptr || *no_color == '\0');
}

}  // namespace

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

int terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

void print_line(const std::string& line) {
  // Where both streams go to the same place, this keeps the order of output.
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", line.c_str());
}

void print_error(const std::string& message) {
  const char* prefix = use_color() ? "photile: \033[1;31merror:\033[0m " : "photile: error: ";
  print_line(prefix + one_line(message));
}

namespace {

/// 0 to 1; 0 where the total is not known. A stage may report more units than it announced.
double fraction(const StageProgress& progress) {
  if (progress.total == 0) return 0;
  return std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(progress.total));
}

/// Of a stage that has begun: "3.8 s".
std::string remaining(const StageProgress& progress) {
  return format_seconds(progress.seconds * (1 / fraction(progress) - 1));
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
  if (fraction(progress) == 0) {  // 0% for some time would look as if nothing were done
    tail = fmt::format("{}  {}", format_seconds(progress.seconds), rate(progress));
  } else {
    tail = fmt::format(" {:3.0f}%  {} | {}  {}", 100 * fraction(progress),
                       format_seconds(progress.seconds), remaining(progress), rate(progress));
    // The bar takes the columns that the text leaves, without brackets and the last column.
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
  if (fraction(progress) == 0) return fmt::format("{}: {}", progress.stage, elapsed);
  return fmt::format("{}: {:.0f}%, {}, {} left", progress.stage, 100 * fraction(progress), elapsed,
                     remaining(progress));
}

std::string completed_text(const StageProgress& progress) {
  const std::string speed = rate(progress);
  return fmt::format("{}: {}{}{}", progress.stage, format_seconds(progress.seconds),
                     speed.empty() ? "" : ", ", speed);
}

namespace {

constexpr auto bar_period = std::chrono::milliseconds(100);
constexpr auto line_period = std::chrono::seconds(10);  // a log should stay short

}  // namespace

TerminalProgress::TerminalProgress(bool quiet)
    : style_(quiet                  ? Style::quiet
             : stderr_is_terminal() ? Style::bar
                                    : Style::lines) {
  if (style_ != Style::quiet) {
    drawer_ = std::jthread([this](std::stop_token stop) { keep_drawing(stop); });
  }
}

TerminalProgress::~TerminalProgress() {
  drawer_ = {};  // stops and joins
  erase();
}

void TerminalProgress::begin(std::string_view stage, std::uint64_t total, std::string_view unit) {
  const std::scoped_lock lock(mutex_);
  stage_ = {std::string(stage), 0, total, std::string(unit), 0};
  done_ = 0;
  stopwatch_ = {};
  active_ = true;
  if (style_ == Style::bar) draw();
}

void TerminalProgress::advance(std::uint64_t count) {
  done_.fetch_add(count, std::memory_order_relaxed);
}

void TerminalProgress::end() {
  const std::scoped_lock lock(mutex_);
  if (!active_) return;
  active_ = false;
  erase();
  if (style_ != Style::quiet) print_line(completed_text(current()));
}

void TerminalProgress::note(const std::string& line) {
  if (style_ != Style::quiet) print_above(line);
}

void TerminalProgress::warn(const std::string& line) {
  if (leads()) print_above("warning: " + line);
}

void TerminalProgress::print_above(const std::string& line) {
  const std::scoped_lock lock(mutex_);
  erase();
  print_line(one_line(line));
  if (active_ && style_ == Style::bar) draw();
}

bool TerminalProgress::cancelled() const { return stop_requested() || other_failed(); }

void TerminalProgress::keep_drawing(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  const auto period = style_ == Style::bar ? std::chrono::milliseconds(bar_period)
                                           : std::chrono::milliseconds(line_period);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, period, [] { return false; });
    if (!stop.stop_requested() && active_) draw();
  }
}

void TerminalProgress::draw() {
  if (style_ == Style::bar) {
    // Carriage return, the bar, then erase to the end of the line.
    std::fprintf(stderr, "\r%s\033[K", progress_bar(current(), terminal_width()).c_str());
    drawn_ = true;
  } else {
    print_line(progress_text(current()));
  }
}

void TerminalProgress::erase() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

StageProgress TerminalProgress::current() const {
  StageProgress progress = stage_;
  progress.done = done_.load(std::memory_order_relaxed);
  progress.seconds = stopwatch_.seconds();
  return progress;
}

std::string format_count(double count) {
  static constexpr std::array suffixes{"", "k", "M", "G", "T"};
  std::size_t suffix = 0;
  // 999.5 would be printed as 1e+03.
  while (std::abs(count) >= 999.5 && suffix + 1 < suffixes.size()) {
    count /= 1000;
    ++suffix;
  }
  if (suffix == 0) return fmt::format("{:.3g}", count);
  return fmt::format("{:.1f}{}", count, suffixes[suffix]);
}

std::string format_bytes(std::uint64_t bytes) {
  static constexpr std::array suffixes{"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return fmt::format("{} B", bytes);
  double value = static_cast<double>(bytes) / 1024;
  std::size_t suffix = 0;
  while (value >= 1024 && suffix + 1 < suffixes.size()) {
    value /= 1024;
    ++suffix;
  }
  return fmt::format("{:.1f} {}", value, suffixes[suffix]);
}

std::string format_seconds(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 9.995) return fmt::format("{:.2f} s", seconds);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string format_power(double power, PowerUnit unit) {
  return report::grouped(power, 4) + " " + symbol_of(unit);
}

std::string format_power_in_lumens(double power, PowerUnit unit, double lumen_per_watt) {
  const std::string own = format_power(power, unit);
  if (unit == PowerUnit::lumen) return own;
  return own + " (" + format_power(power * lumen_per_watt, PowerUnit::lumen) + ")";
}

}  // namespace photile::app
