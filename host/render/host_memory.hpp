// How much memory the host has to spare.
#pragma once

#include <cstdint>

namespace photile {

/// Bytes that can be allocated without swapping, by the system's own estimate and the limit of the
/// process's control group. The largest number where nothing is known.
std::uint64_t available_host_bytes();

}  // namespace photile
