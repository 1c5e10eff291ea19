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
  /// Waits for the launches so far and sums them, by kernel name.
  std::vector<KernelTime> total();

 private:
  void collect();

  std::vector<std::pair<std::string, EventHandle>> pending_;
  std::map<std::string, KernelTime> totals_;
};

}  // namespace photile::device
