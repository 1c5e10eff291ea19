// Where the viewer stands and looks.
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

  /// The same turn around the point `distance` metres ahead, which stays where it is in the
  /// picture: the viewer moves to the left when it turns to the right.
  void orbit(double right, double upwards, double distance);

 private:
  Camera camera_;
};

}  // namespace photile::view
