// Work on several devices at once, and how hits are shared between them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "photile/device.hpp"
#include "photile/progress.hpp"

namespace photile::estimate {

/// Calls work(i, progress) for every device i, each on its own thread, and returns once all have
/// ended. The first device reports its stages to `progress`; all of them are asked to stop when the
/// user asks for it. Where one fails, the others are asked to stop, and the error is thrown once
/// they have: that of the first of the devices that failed by themselves, a DeviceError with its
/// device's name.
void for_each_device(std::span<Device> devices, Progress& progress,
                     const std::function<void(std::size_t, Progress&)>& work);

/// Shares hits by the throughput that each device has shown so far. The first hits are divided
/// evenly: a few that are not measured, since they wait for kernels, then some that are.
class LoadBalance {
 public:
  explicit LoadBalance(std::size_t devices);

  /// How many of the next `left` hits to share before measuring again; at least 1 unless left is 0.
  std::size_t round(std::size_t left) const;

  /// Positions where `count` hits are cut: device i takes [cuts[i], cuts[i + 1]). Ascending, from 0
  /// to `count`.
  std::vector<std::size_t> cuts(std::size_t count) const;

  /// Device `device` took `seconds` for `hits` of this round.
  void record(std::size_t device, std::size_t hits, double seconds);
  void end_round() { ++rounds_; }

  /// Each device's part of all hits so far, in [0, 1]; together 1, or 0 without hits.
  std::vector<double> fractions() const;

 private:
  struct Work {
    std::size_t hits = 0;           ///< all
    std::size_t measured_hits = 0;  ///< those whose time counts
    double seconds = 0;
  };

  double throughput(const Work& work) const;

  std::vector<Work> work_;
  std::size_t rounds_ = 0;
};

}  // namespace photile::estimate
