// What a run took: the time before its first line, and the tables at its end.
#pragma once

#include <string>
#include <vector>

#include "command/run_record.hpp"
#include "device/context.hpp"
#include "photile/statistics.hpp"

namespace photile::app {

/// What the loading of its libraries took: to be asked for in the beginning. Wall clock to a
/// hundredth of a second; processor seconds where the system does not tell.
TimeTaken time_of_loading();

/// A line per stage: seconds, memory on host and device, figures; then the total.
std::vector<std::string> summary_table(const RunRecord& record);

/// A line per kernel: launches, total and mean time, slowest first.
std::vector<std::string> kernel_table(std::vector<device::KernelTime> times);

}  // namespace photile::app
