// How much memory the host has.
#pragma once

#include <cstdint>

namespace photile {

/// Bytes installed, or the limit of the process's control group where that is less: the same on
/// every run, whatever else is running. The largest number where nothing is known.
std::uint64_t installed_host_bytes();

}  // namespace photile
