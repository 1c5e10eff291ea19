// What a device can do at best, for comparison with what kernels reach.
#pragma once

#include "photile/device.hpp"
#include "support/timing.hpp"

namespace photile::bench {

struct DeviceLimits {
  double copied_bytes_per_second = 0;  ///< read and written, from buffers that no cache holds
  double cached_bytes_per_second = 0;  ///< read from 8 KiB, which a first-level cache holds
  /// Single-precision additions and multiplications that are not fused, as in photile's kernels.
  double operations_per_second = 0;
};

/// Medians over kernels made for it. The device must have been opened with DeviceOptions::profile.
///   copied_bytes   size of the buffers copied; more than twice the last cache
DeviceLimits measure_limits(Device& device, const Repeats& repeats, std::size_t copied_bytes);

}  // namespace photile::bench
