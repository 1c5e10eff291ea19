// How a camera moves.
#pragma once

#include <functional>

#include "photile/camera.hpp"

namespace photile::walk {

/// A camera at any time in [begin, end], seconds; in the scene file's world.
struct CameraMotion {
  double begin = 0, end = 0;
  std::function<Camera(double time)> at;
};

}  // namespace photile::walk
