// The tables at the end of a run.
#pragma once

#include <string>
#include <vector>

#include "device/context.hpp"
#include "tools/command/run_record.hpp"

namespace photile::app {

/// A line per stage: seconds, memory on host and device, figures; then the total.
std::vector<std::string> summary_table(const RunRecord& record);

/// A line per kernel: launches, total and mean time, slowest first.
std::vector<std::string> kernel_table(std::vector<device::KernelTime> times);

}  // namespace photile::app
