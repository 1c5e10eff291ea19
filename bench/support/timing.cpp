#include "support/timing.hpp"

#include <sys/resource.h>

#include "photile/statistics.hpp"

namespace photile::bench {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

rusage used() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

}  // namespace

void RunTimes::count(const std::function<void()>& run) {
  const rusage before = used();
  const Stopwatch stopwatch;
  run();
  wall.seconds.push_back(stopwatch.seconds());
  const rusage after = used();
  const double in_system = seconds_of(after.ru_stime) - seconds_of(before.ru_stime);
  system.seconds.push_back(in_system);
  processor.seconds.push_back(in_system + seconds_of(after.ru_utime) - seconds_of(before.ru_utime));
}

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
