#include "command/terminal_progress.hpp"

#include <chrono>
#include <cstdio>

#include "command/processes.hpp"
#include "command/signals.hpp"
#include "command/terminal.hpp"
#include "common/ascii_text.hpp"

namespace photile::app {
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
  if (style_ == Style::quiet) return;
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

}  // namespace photile::app
