// What each stage cost: a record of time, memory and figures.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace photile {

/// Cost of one stage.
struct StageStatistics {
  std::string stage;               ///< "trace photons", "build photon maps", ...
  double seconds = 0;              ///< wall clock
  std::uint64_t host_bytes = 0;    ///< memory that the stage's result keeps on the host
  std::uint64_t device_bytes = 0;  ///< memory that the stage's result keeps on the device
  /// Named figures of the stage, in the order they were added ("photons per second", 1.9e6).
  std::vector<std::pair<std::string, double>> figures;
};

/// The stages of a run, in order.
using RunStatistics = std::vector<StageStatistics>;

/// Wall-clock seconds since construction.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace photile
