// Device time, apart from what the host does around it.
#pragma once

#include "device/context.hpp"
#include "photile/device.hpp"

namespace photile::bench {

/// Seconds that all kernels have run so far; needs DeviceOptions::profile.
inline double kernel_seconds(Device& device) {
  double seconds = 0;
  for (const device::KernelTime& time : device.context().kernel_times()) seconds += time.seconds;
  return seconds;
}

/// Kernel seconds of one call.
template <class Run>
double kernel_seconds_of(Device& device, Run run) {
  const double before = kernel_seconds(device);
  run();
  return kernel_seconds(device) - before;
}

}  // namespace photile::bench
