// Device time, apart from what the host does around it.
#pragma once

#include <ctime>
#include <map>
#include <string>

#include "device/context.hpp"
#include "photile/device.hpp"

namespace photile::bench {

/// Seconds that each kernel has run so far; needs DeviceOptions::profile.
inline std::map<std::string, double> seconds_by_kernel(Device& device) {
  std::map<std::string, double> seconds;
  for (const device::KernelTime& time : device::context_of(device).kernel_times()) {
    seconds[time.kernel] = time.seconds;
  }
  return seconds;
}

/// Seconds that each kernel runs in one call.
template <class Run>
std::map<std::string, double> seconds_by_kernel_of(Device& device, Run run) {
  const std::map<std::string, double> before = seconds_by_kernel(device);
  run();
  std::map<std::string, double> seconds = seconds_by_kernel(device);
  for (const auto& [kernel, earlier] : before) seconds[kernel] -= earlier;
  return seconds;
}

/// Kernel seconds of one call.
template <class Run>
double kernel_seconds_of(Device& device, Run run) {
  double sum = 0;
  for (const auto& [kernel, seconds] : seconds_by_kernel_of(device, run)) sum += seconds;
  return sum;
}

/// Seconds of one call: of its kernels on a GPU; where device and host are one processor, processor
/// time of all threads, which other programs disturb least.
template <class Run>
double device_or_processor_seconds_of(Device& device, Run run) {
  if (device.info().type != DeviceType::cpu) return kernel_seconds_of(device, run);
  const std::clock_t begin = std::clock();
  run();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace photile::bench
