// Exclusive prefix sum on the device.
#pragma once

#include <cstdint>

#include "device/kernel_set.hpp"

namespace photile::maps {

/// Replaces `values` by their exclusive prefix sum. `kernels`: of a program that holds
/// shared/scan.cl. With a zero appended by the caller, the last element becomes the total. Sums
/// must stay below 2^32.
void exclusive_prefix_sum(const device::KernelSet& kernels, device::Buffer<std::uint32_t>& values);

/// The exclusive prefix sum, into another buffer of the same size.
void exclusive_prefix_sum(const device::KernelSet& kernels,
                          const device::Buffer<std::uint32_t>& values,
                          device::Buffer<std::uint32_t>& scanned);

}  // namespace photile::maps
