// Which device a selector means. No OpenCL call: testable with invented devices.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "photile/device.hpp"

namespace photile::device {

/// Environment variable that is the selector where none is given.
inline constexpr const char* device_variable = "PHOTILE_DEVICE";

/// Index of the device that `selector` means (see DeviceOptions::selector). Of several matches the
/// best is taken: a GPU, then PoCL, then another CPU, then anything else, Oclgrind's simulator
/// last; the first listed among equals. "" means $PHOTILE_DEVICE where that is set. Errors:
/// DeviceError that lists `devices` when none matches, and names `left_out` when there are none at
/// all.
std::size_t select_device(std::span<const DeviceInfo> devices, std::string selector,
                          std::span<const std::string> left_out = {});

}  // namespace photile::device
