// How many hits are estimated at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "device/context.hpp"
#include "photile/errors.hpp"

namespace photile::estimate {

/// Device memory that each hit of a batch takes.
struct HitBatchNeeds {
  std::uint64_t largest_bytes_per_hit;  ///< in the largest buffer, input or output
  std::uint64_t bytes_per_hit;          ///< in all together
};

/// Hits of a batch, at least one: so many that no buffer is larger than `largest_buffer` or than
/// what 32 bits address, all together take a quarter of `memory` (the rest is for photon maps), and
/// not more than fill a device comfortably.
std::size_t plan_hit_batch(const HitBatchNeeds& needs, std::uint64_t largest_buffer,
                           std::uint64_t memory);

/// Runs work in batches, smaller ones where the device's memory does not suffice.
class HitBatches {
 public:
  explicit HitBatches(device::Context& context) : context_(context) {}

  /// Calls work(first, count) for hits [0, hits) in order. A call that throws DeviceMemoryError is
  /// repeated with half as many hits, and so are the later ones. Errors: DeviceMemoryError where a
  /// single hit does not fit.
  template <class Work>
  void run(std::size_t hits, const HitBatchNeeds& needs, const Work& work) {
    const std::size_t planned =
        plan_hit_batch(needs, context_.largest_buffer(), context_.memory_limit());
    for (std::size_t first = 0; first < hits;) {
      const std::size_t count = std::min({planned, most_, hits - first});
      try {
        work(first, count);
        first += count;
      } catch (const DeviceMemoryError&) {
        if (count == 1) throw;
        most_ = count / 2;
      }
    }
  }

 private:
  device::Context& context_;
  std::size_t most_ = static_cast<std::size_t>(-1);  ///< that have not failed
};

}  // namespace photile::estimate
