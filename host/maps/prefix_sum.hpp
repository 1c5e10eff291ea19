// Exclusive prefix sum on the device.
#pragma once

#include <cstdint>

#include "device/context.hpp"

namespace photile::maps {

/// Replaces `values` by their exclusive prefix sum. With a zero appended by the caller, the last
/// element becomes the total. Sums must stay below 2^32.
void exclusive_prefix_sum(device::Context& context, device::Buffer<std::uint32_t>& values);

/// The same, into another buffer of the same size.
void exclusive_prefix_sum(device::Context& context, const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned);

}  // namespace photile::maps
