// Sub-devices: compute units of one device that work as a device of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "device/device_list.hpp"

namespace photile::device {

/// Splits `whole` by clCreateSubDevices into parts of `compute_units` each. A part's id is the
/// whole's with ".0", ".1", ... ; its memory is an equal share of the whole's, since all parts fill
/// the same. Errors: DeviceError when the device cannot be split like that.
std::vector<ListedDevice> make_sub_devices(const ListedDevice& whole,
                                           std::span<const std::uint32_t> compute_units);

}  // namespace photile::device
