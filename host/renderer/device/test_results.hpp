// Results of device tests, kept beside the compiled kernels.
#pragma once

#include <string>

#include "photile/device.hpp"

namespace photile::device {

/// What DeviceInfo::test_result says of a device that has passed.
inline constexpr const char* passed = "passed";

/// The result of the last test of this device with this driver and these kernels; "" where none is
/// kept.
std::string kept_test_result(const DeviceInfo& device);

/// Keeps a result. Nothing where no folder can be written, which is a warning.
void keep_test_result(const DeviceInfo& device, const std::string& result);

}  // namespace photile::device
