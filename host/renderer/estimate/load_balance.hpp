// How hits are shared between devices.
#pragma once

#include <cstddef>
#include <vector>

namespace photile::estimate {

/// Shares hits by the throughput that each device has shown so far. The first hits are shared
/// evenly: a few that are not measured, since they wait for kernels to be compiled, then a probe.
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
  std::vector<double> shares() const;

 private:
  struct Work {
    std::size_t hits = 0;           ///< all
    std::size_t measured_hits = 0;  ///< those of which the time counts
    double seconds = 0;
  };

  double throughput(const Work& work) const;

  std::vector<Work> work_;
  std::size_t rounds_ = 0;
};

}  // namespace photile::estimate
