// The OpenCL devices of this machine, with their handles.
#pragma once

#include <string>
#include <vector>

#include "device/opencl.hpp"
#include "photile/device.hpp"

namespace photile::device {

struct ListedDevice {
  DeviceInfo info;
  cl_platform_id platform = nullptr;
  cl_device_id device = nullptr;
  SubDeviceHandle sub_device{};  ///< owns `device` where that is a sub-device
};

struct DeviceList {
  std::vector<ListedDevice> usable;
  /// What was found and left out, with the reason: "Clover: not supported".
  std::vector<std::string> left_out;
};

/// Asks every platform. Prepares PoCL's cache first, because PoCL reads its folder on the first
/// call. Errors: DeviceError when the loader itself fails.
DeviceList enumerate_devices();

}  // namespace photile::device
