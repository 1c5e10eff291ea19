// Which devices a selector means. No OpenCL call: testable with invented devices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "photile/device.hpp"

namespace photile::device {

/// Environment variable that is the selector where none is given.
inline constexpr const char* device_variable = "PHOTILE_DEVICE";

struct DeviceChoice {
  std::size_t index = 0;                       ///< into the list chosen from
  std::vector<std::uint32_t> compute_units{};  ///< of each sub-device; empty = the whole device
  friend bool operator==(const DeviceChoice&, const DeviceChoice&) = default;
};

/// The devices that `selector` means (see DeviceOptions::selector), in its order. Of several that a
/// name matches the best is taken: a GPU, then PoCL, then another CPU, then anything else,
/// Oclgrind's simulator last; the first listed among equals. "" means $PHOTILE_DEVICE where that is
/// set. Errors: DeviceError that lists `devices` when a name matches none, and names `left_out`
/// when there are none at all; when one is named twice, or has fewer compute units than are asked
/// for.
std::vector<DeviceChoice> select_devices(std::span<const DeviceInfo> devices, std::string selector,
                                         std::span<const std::string> left_out = {});

}  // namespace photile::device
