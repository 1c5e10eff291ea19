#include "support/timing.hpp"

#include "photile/statistics.hpp"

namespace photile::bench {

double Timing::median() const {
  std::vector<double> sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

Timing measure_returned(const Repeats& repeats, const std::function<double()>& run) {
  const Stopwatch all;
  run();
  Timing timing;
  for (int i = 0; i < repeats.most; ++i) {
    if (!repeats.all && i >= 3 && all.seconds() > repeats.seconds_per_case) break;
    timing.seconds.push_back(run());
  }
  return timing;
}

Timing measure(const Repeats& repeats, const std::function<void()>& run) {
  return measure_returned(repeats, [&run] {
    const Stopwatch stopwatch;
    run();
    return stopwatch.seconds();
  });
}

}  // namespace photile::bench
