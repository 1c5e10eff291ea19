// Where the viewer stands and looks, and how keys and mouse move it.
#pragma once

#include "photile/camera.hpp"

namespace photile::view {

/// A camera that walks, turns and orbits. Up is +y, as in glTF; what the first camera has of roll
/// stays.
class Viewpoint {
 public:
  explicit Viewpoint(const Camera& start) : camera_(start) {}

  const Camera& camera() const { return camera_; }

  /// Metres along the heading, which is level however the head is tilted, to the right, and up.
  void walk(double forward, double right, double up);

  /// Turns the head: radians to the right and upwards, no farther than nearly straight up or down.
  void turn(double right, double upwards);

  /// Turns likewise around the point `distance` metres ahead, which stays where it is in the
  /// picture: the viewer moves to the left when it turns to the right.
  void orbit(double right, double upwards, double distance);

 private:
  Camera camera_;
};

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

  /// Whether a click, no drag, ended in this frame.
  bool clicked() const;

  double& speed() { return speed_; }

 private:
  double speed_, orbit_distance_;
};

}  // namespace photile::view
