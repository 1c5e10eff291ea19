// The OpenCL device of a test executable: opened once, since compiling kernels takes seconds.
#pragma once

#include <optional>

#include "before_exit.hpp"
#include "photile/device.hpp"

namespace photile::test {

/// The device that PHOTILE_DEVICE names, or the best there is. No device at all is an error: a test
/// that runs nowhere must not pass.
inline Device& device() {
  static std::optional<Device> opened;
  if (!opened) {
    opened.emplace();
    before_exit = [] { opened.reset(); };
  }
  return *opened;
}

}  // namespace photile::test
