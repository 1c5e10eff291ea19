// Device time per kernel, from profiling events.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "device/context.hpp"
#include "device/opencl.hpp"

namespace photile::device {

class KernelTimes {
 public:
  /// Takes over the event of one launch.
  void add(const std::string& kernel, EventHandle event);
  /// Takes over the event of a launch that took `seconds` from its call to its end: the part of
  /// them in which it did not run is preparation.
  void add_first(const std::string& kernel, EventHandle event, double seconds);
  /// Adds seconds spent until a kernel could run.
  void add_preparation(const std::string& kernel, double seconds);
  /// Waits for the launches so far and sums them, by name of the kernels launched.
  std::vector<KernelTime> total();

 private:
  void collect();

  std::vector<std::pair<std::string, EventHandle>> pending_;
  std::map<std::string, KernelTime> totals_;
};

}  // namespace photile::device
