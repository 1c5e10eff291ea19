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
/// set; else the best, where GPUs that have not passed their test come after CPUs. Errors:
/// DeviceError that lists `devices` when a name matches none, and names `left_out` when there are
/// none at all; when one is named twice, or has fewer compute units than are asked for.
std::vector<DeviceChoice> select_devices(std::span<const DeviceInfo> devices, std::string selector,
                                         std::span<const std::string> left_out = {});

/// Why `chosen`, the choice for "", is a CPU although there is a GPU, or a GPU that has not passed
/// its test: one line; "" where neither is the case.
std::string untested_gpu(std::span<const DeviceInfo> devices, const DeviceInfo& chosen);

/// Whether `selector`, or the environment variable used instead, leaves the choice to photile.
bool chooses_best(const std::string& selector);

}  // namespace photile::device
