#include "view/viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

namespace photile::view {
namespace {

const glm::dvec3 up_axis(0, 1, 0);
constexpr double steepest = glm::radians(89.0);

}  // namespace

void Viewpoint::walk(double forward, double right, double up) {
  glm::dvec3 heading = camera_.forward - glm::dot(camera_.forward, up_axis) * up_axis;
  // Straight down or up, the top of the picture is ahead.
  if (glm::length(heading) < 1e-6) heading = camera_.up - glm::dot(camera_.up, up_axis) * up_axis;
  heading = glm::normalize(heading);
  camera_.position += forward * heading + right * glm::cross(heading, up_axis) + up * up_axis;
}

void Viewpoint::turn(double right, double upwards) {
  const double pitch = std::asin(std::clamp(glm::dot(camera_.forward, up_axis), -1.0, 1.0));
  // A first camera that is steeper than that may only turn back.
  const double lowest = std::min(-steepest, pitch), highest = std::max(steepest, pitch);
  const double tilt = std::clamp(pitch + upwards, lowest, highest) - pitch;
  for (glm::dvec3* axis : {&camera_.forward, &camera_.up}) {
    *axis = glm::rotate(glm::rotate(*axis, tilt, camera_.right), -right, up_axis);
  }
  // Thousands of turns must not bend the basis.
  camera_.forward = glm::normalize(camera_.forward);
  camera_.right = glm::normalize(glm::cross(camera_.forward, camera_.up));
  camera_.up = glm::cross(camera_.right, camera_.forward);
}

void Viewpoint::orbit(double right, double upwards, double distance) {
  const glm::dvec3 pivot = camera_.position + distance * camera_.forward;
  turn(right, upwards);
  camera_.position = pivot - distance * camera_.forward;
}

}  // namespace photile::view
