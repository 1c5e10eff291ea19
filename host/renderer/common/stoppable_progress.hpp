// Progress of work that may be stopped by others than the user.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "photile/progress.hpp"

namespace photile {

/// Passes on reports and requests to stop; `stopped` is a further request to stop.
class StoppableProgress : public Progress {
 public:
  /// Keeps a reference to `to`.
  StoppableProgress(Progress& to, std::function<bool()> stopped)
      : to_(to), stopped_(std::move(stopped)) {}

  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override {
    to_.begin(stage, total, unit);
  }
  void advance(std::uint64_t count) override { to_.advance(count); }
  void end() override { to_.end(); }
  void note(const std::string& line) override { to_.note(line); }
  void warn(const std::string& line) override { to_.warn(line); }
  bool cancelled() const override { return to_.cancelled() || stopped_(); }

 private:
  Progress& to_;
  std::function<bool()> stopped_;
};

}  // namespace photile
