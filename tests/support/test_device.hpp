// The OpenCL device of a test executable: opened once, since compiling kernels takes seconds.
#pragma once

#include "photile/device.hpp"

namespace photile::test {

/// The device that PHOTILE_DEVICE names, or the best there is. No device at all is an error: a test
/// that runs nowhere must not pass.
inline Device& device() {
  static Device opened;
  return opened;
}

}  // namespace photile::test
