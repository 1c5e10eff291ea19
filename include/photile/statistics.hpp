// The cost of each stage: a record of time, memory and figures.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace photile {

/// Cost of one stage.
struct StageStatistics {
  std::string stage;               ///< "trace photons", "build photon maps", ...
  double seconds = 0;              ///< wall clock
  double processor_seconds = 0;    ///< of all threads of the process, whatever they did
  std::uint64_t host_bytes = 0;    ///< memory that the stage's result keeps on the host
  std::uint64_t device_bytes = 0;  ///< memory that the stage's result keeps on the device
  /// Named figures of the stage, in the order they were added ("photons per second", 1.9e6).
  std::vector<std::pair<std::string, double>> figures;
};

/// The stages of a run, in order.
using RunStatistics = std::vector<StageStatistics>;

/// The time that some work took.
struct TimeTaken {
  double seconds = 0;            ///< wall clock
  double processor_seconds = 0;  ///< of all threads of the process

  TimeTaken& operator+=(const TimeTaken& more) {
    seconds += more.seconds;
    processor_seconds += more.processor_seconds;
    return *this;
  }
  TimeTaken operator-(const TimeTaken& part) const {
    return {seconds - part.seconds, processor_seconds - part.processor_seconds};
  }
};

/// Time since construction.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  TimeTaken taken() const { return {seconds(), processor_now() - processor_start_}; }

 private:
  static double processor_now() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
  }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double processor_start_ = processor_now();
};

}  // namespace photile
