// Whether a device computes right: what decides if a GPU is taken by default.
#pragma once

#include <string>

#include "photile/device.hpp"

namespace photile {

/// Builds photon maps of 20,000 uniform photons on a square metre and asks the device for the 50
/// nearest of a thousand hits and for their irradiance. Both are compared with a search of all
/// photons in double precision, and the mean irradiance with that which the photons were made for.
/// Takes seconds, most of them for compiling kernels. Returns "" where all agree, else what does
/// not, in one line; an error of the device is such a line, too.
std::string test_device(Device& device);

/// The same, and keeps the result for later runs (DeviceInfo::test_result).
std::string test_device_and_remember(Device& device);

}  // namespace photile
