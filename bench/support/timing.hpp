// Repeated measurements of one case.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace photile::bench {

/// Seconds of each repeat, in the order they ran.
struct Timing {
  std::vector<double> seconds;

  double smallest() const { return *std::min_element(seconds.begin(), seconds.end()); }
  double largest() const { return *std::max_element(seconds.begin(), seconds.end()); }
  /// The middle repeat; the mean of the two middle ones where their number is even.
  double median() const;
};

/// What the repeats of a case took, counted apart.
struct RunTimes {
  Timing wall;
  /// Of all threads of this process: other programs disturb it least.
  Timing processor;
  Timing system;  ///< the operating system's part of that: above all, memory touched at first

  /// Runs it once.
  void count(const std::function<void()>& run);
};

/// How often a case runs.
struct Repeats {
  int most = 5;
  /// A case that has run for this long, warm-up included, ends after its third repeat.
  double seconds_per_case = 1.5;
  bool all = false;  ///< every case has `most`, however long it takes
};

/// Times `run` after one untimed call, which compiles kernels and touches memory for the first
/// time.
Timing measure(const Repeats& repeats, const std::function<void()>& run);

/// Measures, as `measure` does, something that times itself: `run` returns its seconds.
Timing measure_returned(const Repeats& repeats, const std::function<double()>& run);

}  // namespace photile::bench
