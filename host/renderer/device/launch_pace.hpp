// Launches that end soon: a display's watchdog stops kernels that run for seconds, and a user who
// cancels waits for the one that runs.
#pragma once

#include <algorithm>
#include <cstdint>

#include "device/context.hpp"
#include "photile/statistics.hpp"

namespace photile::device {

/// Items of the next launch, from what the last one took: as many as take a tenth of a second, at
/// most four times as many as the last, for the first launches of a kernel are slow.
inline std::uint32_t next_launch(std::uint32_t last, double seconds) {
  constexpr double wanted_seconds = 0.1, most_growth = 4;
  constexpr double least = 1024, most = 1u << 30;
  const double growth = seconds > 0 ? std::min(wanted_seconds / seconds, most_growth) : most_growth;
  return static_cast<std::uint32_t>(std::clamp(last * growth, least, most));
}

/// Cuts the items of a kernel into launches by their measured time. Two are in the queue at a time,
/// so that the device need not wait for the host between them; run() returns before the last has
/// ended. On CPUs, which have no watchdog and whose runtimes share time with others, one launch
/// does all.
class LaunchPace {
 public:
  explicit LaunchPace(Context& context)
      : context_(context), cuts_(context.info().type != DeviceType::cpu) {}

  /// Calls launch(first, count) for [0, total), part by part; parts are multiples of `unit` but for
  /// the last.
  template <class Launch>
  void run(std::uint32_t total, std::uint32_t unit, Launch launch) {
    if (!cuts_) {
      launch(0u, total);
      return;
    }
    for (std::uint32_t first = 0; first < total;) {
      const std::uint32_t part = (items_ + unit - 1) / unit * unit;
      const std::uint32_t count = std::min(part, total - first);
      const double enqueued = clock_.seconds();
      launch(first, count);
      // Small rests say little.
      const InQueue launched{context_.mark(), enqueued, count == part ? part : 0};
      end_last();
      last_ = launched;
      first += count;
    }
  }

 private:
  struct InQueue {
    Event end;
    double enqueued = 0;         ///< seconds
    std::uint32_t measured = 0;  ///< items, where its time is to be taken
  };

  /// Waits for the last launch but the one just enqueued. It ran from the end of the one before, or
  /// from when it was enqueued.
  void end_last() {
    context_.wait(last_.end);
    const double ended = clock_.seconds();
    if (last_.measured > 0) {
      items_ = next_launch(last_.measured, ended - std::max(last_.enqueued, ended_));
    }
    ended_ = ended;
  }

  Context& context_;
  bool cuts_;
  std::uint32_t items_ = 1u << 14;
  Stopwatch clock_;
  InQueue last_;
  double ended_ = 0;  ///< when the launch before the last ended, seconds
};

}  // namespace photile::device
