// Resources without which libraries end the process: threads, which TBB and PoCL make, and
// addresses, which PoCL's compiler takes.
#pragma once

#include <array>
#include <cstdint>

namespace photile {

/// Environment variables that set how many threads PoCL starts: before version 4, and from
/// it on.
inline constexpr std::array pocl_thread_variables{"POCL_MAX_PTHREAD_COUNT",
                                                  "POCL_CPU_MAX_CU_COUNT"};

/// At least 1.
int core_count();

/// TBB and PoCL abort where a thread cannot be created, so this is checked first.
/// Errors: Error where the system does not allow the process that many more threads.
void require_threads(int count);

/// Errors: Error where stacks are too small for the code that runs on them.
void require_stack();

/// Threads of this process, and those that they begin, take what processor time other programs
/// leave.
void lower_priority();

/// A generous bound on the memory of a device's compiler, and of the host besides its buffers.
inline constexpr std::uint64_t reserved_address_bytes = std::uint64_t{1} << 30;

/// Bytes of addresses that the process may have beyond those it has (ulimit -v).
std::uint64_t address_bytes_left();

}  // namespace photile
