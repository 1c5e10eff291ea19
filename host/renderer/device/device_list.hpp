// The OpenCL devices of this machine, with their handles, and sub-devices of them.
#pragma once

#include <cstdint>
#include <span>
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
  /// Devices that were found and left out, with the reason: "Clover: not supported".
  std::vector<std::string> left_out;
};

/// Asks every platform. Prepares PoCL's cache first, because PoCL reads its folder on the first
/// call. Errors: DeviceError when the loader itself fails.
DeviceList enumerate_devices();

/// Sub-devices: splits `whole` by clCreateSubDevices into parts of `compute_units` each. A part's
/// id is the whole's with ".0", ".1", ... ; its memory is an equal part of the whole's, since all
/// parts share it. Errors: DeviceError when the device cannot be split like that.
std::vector<ListedDevice> make_sub_devices(const ListedDevice& whole,
                                           std::span<const std::uint32_t> compute_units);

}  // namespace photile::device
