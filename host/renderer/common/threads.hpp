// Threads that others make for photile: TBB, and PoCL for its devices.
#pragma once

#include <array>

namespace photile {

/// Variables of the environment that hold how many threads PoCL starts: before version 4, and from
/// it on.
inline constexpr std::array pocl_thread_variables{"POCL_MAX_PTHREAD_COUNT",
                                                  "POCL_CPU_MAX_CU_COUNT"};

/// At least 1.
int core_count();

/// TBB and PoCL abort where a thread cannot be made; this is asked before them.
/// Errors: Error where the system does not let the process have as many threads more.
void require_threads(int count);

}  // namespace photile
