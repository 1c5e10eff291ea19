// Keys and mouse to motion.
#pragma once

#include "view/viewpoint.hpp"

namespace photile::view {

/// Walks with W A S D, E and Q (up, down), looks around with the left button, orbits with the
/// right, and goes ahead with the wheel. Input that the panels take is not for it.
class Navigation {
 public:
  /// Metres per second, and metres to what the right button orbits.
  Navigation(double speed, double orbit_distance)
      : speed_(speed), orbit_distance_(orbit_distance) {}

  /// Applies the input of this frame. Returns whether the viewpoint moved.
  ///   left_taken   the left button drags something else
  bool update(Viewpoint& viewpoint, bool left_taken = false);

  /// Whether a click, no drag, ended in this frame; where.
  bool clicked(double& x, double& y) const;

  double& speed() { return speed_; }

 private:
  double speed_, orbit_distance_;
};

}  // namespace photile::view
