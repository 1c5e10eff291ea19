// Figures of a year of daylight, refined on its own thread.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "photile/progress.hpp"

namespace photile::view {

/// Measures on request, and again on each further request. Until then it costs nothing.
class YearWorker {
 public:
  using Lines = std::vector<std::string>;
  /// Reports lines repeatedly, each time all of them, until it is done or stopped.
  using Measure = std::function<void(const std::function<void(Lines)>& tell, Progress& progress)>;

  /// `measure` may be empty: there is no year to measure.
  explicit YearWorker(Measure measure) : measure_(std::move(measure)) {}

  bool possible() const { return measure_ != nullptr; }
  void start();
  bool running() const;
  /// The last that were told; an error is a line, too.
  Lines lines() const;

 private:
  void tell(Lines lines);
  void work(const std::stop_token& stop);

  const Measure measure_;
  mutable std::mutex mutex_;
  Lines lines_;
  bool running_ = false;
  std::jthread thread_;  // last: it uses all of the above, and is stopped first
};

}  // namespace photile::view
